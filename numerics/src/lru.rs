//! Values that are expensive to compute, kept for the steps that share them.

/// Values that were used last, by what they belong to (least recently used: the oldest one makes room); the present one
/// comes first. Sixteen are kept unless a use says otherwise: eight wheels that drive in turn may need two each.
#[derive(Clone, Debug)]
pub struct Lru<K, V, const KEPT: usize = 16> {
    kept: Vec<(K, V)>,
}

impl<K, V, const KEPT: usize> Default for Lru<K, V, KEPT> {
    fn default() -> Self {
        Self { kept: Vec::new() }
    }
}

impl<K, V, const KEPT: usize> Lru<K, V, KEPT> {
    /// Makes the value of `key` the present one; `fill` computes it in the place of the oldest one unless it is kept.
    pub fn select<E>(&mut self, key: K, fill: impl FnOnce(&mut V) -> Result<(), E>) -> Result<(), E>
    where
        K: PartialEq,
        V: Default,
    {
        if !self.find(|of| *of == key) {
            let oldest = if self.kept.len() < KEPT { None } else { self.kept.pop() };
            let mut value = oldest.map_or_else(V::default, |(_, value)| value);
            fill(&mut value)?;
            self.keep(key, value);
        }
        Ok(())
    }

    /// Makes the value of a key that passes a test the present one; whether there is one.
    pub fn find(&mut self, passes: impl Fn(&K) -> bool) -> bool {
        let place = self.kept.iter().position(|(of, _)| passes(of));
        if let Some(place) = place {
            self.kept[..=place].rotate_right(1);
        }
        place.is_some()
    }

    /// Makes a new value the present one.
    pub fn keep(&mut self, key: K, value: V) {
        self.kept.truncate(KEPT - 1);
        self.kept.insert(0, (key, value));
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
