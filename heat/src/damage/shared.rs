//! Data that many copies of a state share until one of them changes, as bytes.

use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::sync::Arc;

/// Writes the data themselves.
pub fn serialize<T: Serialize, S: Serializer>(shared: &Option<Arc<T>>, serializer: S) -> Result<S::Ok, S::Error> {
    shared.as_deref().serialize(serializer)
}

/// Reads them into a copy of their own.
pub fn deserialize<'de, T: Deserialize<'de>, D: Deserializer<'de>>(source: D) -> Result<Option<Arc<T>>, D::Error> {
    Ok(Option::<T>::deserialize(source)?.map(Arc::new))
}
