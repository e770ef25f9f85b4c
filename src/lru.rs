//! Values that are expensive to compute, kept for the steps that share them.

/// Number of values that are kept: eight wheels that drive in turn may need two each.
const KEPT: usize = 16;

/// Values that were used last, by what they belong to (least recently used: the oldest one makes room); the present one
/// comes first.
#[derive(Clone, Debug)]
pub struct Lru<K, V> {
    kept: Vec<(Option<K>, V)>,
}

impl<K, V> Default for Lru<K, V> {
    fn default() -> Self {
        Self { kept: Vec::new() }
    }
}

impl<K: PartialEq, V: Default> Lru<K, V> {
    /// Makes the value of `key` the present one; `fill` computes it in the place of the oldest one unless it is kept.
    pub fn select<E>(&mut self, key: K, fill: impl FnOnce(&mut V) -> Result<(), E>) -> Result<(), E> {
        let known = self.kept.iter().position(|(of, _)| of.as_ref() == Some(&key));
        let place = known.unwrap_or_else(|| {
            if self.kept.len() < KEPT {
                self.kept.push((None, V::default()));
            }
            self.kept.len() - 1
        });
        self.kept[..=place].rotate_right(1);
        if known.is_none() {
            let (of, value) = &mut self.kept[0];
            *of = None;
            fill(value)?;
            *of = Some(key);
        }
        Ok(())
    }

    /// Present value.
    ///
    /// # Panics
    /// If none was ever selected.
    pub fn present(&self) -> &V {
        &self.kept[0].1
    }

    /// Present value, to be changed.
    ///
    /// # Panics
    /// If none was ever selected.
    pub fn present_mut(&mut self) -> &mut V {
        &mut self.kept[0].1
    }
}
