//! What was computed last, kept for the steps that share it.

/// Values that are kept: eight wheels that drive in turn may need two each.
const KEPT: usize = 16;

/// The values that were used last, by what they belong to, the present one first.
#[derive(Clone, Debug)]
pub(super) struct Recent<K, V> {
    kept: Vec<(Option<K>, V)>,
}

impl<K, V> Default for Recent<K, V> {
    fn default() -> Self {
        Self { kept: Vec::new() }
    }
}

impl<K: PartialEq, V: Default> Recent<K, V> {
    /// Makes the value of `key` the present one; `fill` computes it in the place of the oldest one unless it is kept.
    pub fn set<E>(&mut self, key: K, fill: impl FnOnce(&mut V) -> Result<(), E>) -> Result<(), E> {
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

    /// The present value.
    ///
    /// # Panics
    /// If none was ever set.
    pub fn present(&self) -> &V {
        &self.kept[0].1
    }

    /// The same, to be changed.
    ///
    /// # Panics
    /// If none was ever set.
    pub fn present_mut(&mut self) -> &mut V {
        &mut self.kept[0].1
    }

    /// What the present value belongs to.
    #[cfg(test)]
    pub fn key(&self) -> Option<&K> {
        self.kept.first()?.0.as_ref()
    }
}
