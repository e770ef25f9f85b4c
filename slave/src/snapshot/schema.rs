//! The layout of a type as text: names of structs, fields and variants, and types of numbers, in their order.
//!
//! Serialized states carry neither names nor types. Their layout is told by the type itself: a deserializer without
//! data hands out ones and notes what it is asked for. Each alternative of an enumeration is visited in a pass of its
//! own.

use serde::Deserialize;
use serde::de::value::{Error, U32Deserializer};
use serde::de::{
    DeserializeSeed, Deserializer, EnumAccess, IntoDeserializer, MapAccess, SeqAccess, VariantAccess, Visitor,
};
use std::fmt::Write;

/// An enumeration: its name and its variants.
type Alternatives = (&'static str, &'static [&'static str]);

/// The layout of `T`; an error if `T` refuses ones.
pub fn layout<'de, T: Deserialize<'de>>() -> Result<String, Error> {
    let mut tracer = Tracer::default();
    loop {
        T::deserialize(&mut tracer)?;
        // The enumeration that was met last goes on to its next variant; one without further variants is finished.
        while let Some((alternatives, chosen)) = tracer.open.last_mut() {
            *chosen += 1;
            if *chosen < alternatives.1.len() {
                break;
            }
            tracer.finished.push(*alternatives);
            tracer.open.pop();
        }
        if tracer.open.is_empty() {
            return Ok(tracer.text);
        }
    }
}

#[derive(Default)]
struct Tracer {
    text: String,
    /// Enumerations with the variant that this pass visits, in the order in which they were met.
    open: Vec<(Alternatives, usize)>,
    /// Enumerations whose variants have all been visited.
    finished: Vec<Alternatives>,
}

impl Tracer {
    fn note(&mut self, what: impl std::fmt::Display) {
        // Writing to a string cannot fail.
        let _ = write!(self.text, "{what} ");
    }

    /// The variant of an enumeration to visit now.
    fn variant(&mut self, alternatives: Alternatives) -> usize {
        if self.finished.contains(&alternatives) {
            return 0;
        }
        if let Some((_, chosen)) = self.open.iter().find(|(known, _)| *known == alternatives) {
            return *chosen;
        }
        self.open.push((alternatives, 0));
        0
    }
}

/// Numbers and the like: notes the type and hands out a one.
macro_rules! plain {
    ($($method:ident $visit:ident $($value:expr)?;)*) => {$(
        fn $method<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
            self.note(stringify!($visit));
            visitor.$visit($($value)?)
        }
    )*};
}

impl<'de> Deserializer<'de> for &mut Tracer {
    type Error = Error;

    plain! {
        deserialize_any visit_unit;
        deserialize_bool visit_bool true;
        deserialize_i8 visit_i8 1;
        deserialize_i16 visit_i16 1;
        deserialize_i32 visit_i32 1;
        deserialize_i64 visit_i64 1;
        deserialize_u8 visit_u8 1;
        deserialize_u16 visit_u16 1;
        deserialize_u32 visit_u32 1;
        deserialize_u64 visit_u64 1;
        deserialize_f32 visit_f32 1.0;
        deserialize_f64 visit_f64 1.0;
        deserialize_char visit_char '1';
        deserialize_str visit_str "1";
        deserialize_string visit_str "1";
        deserialize_bytes visit_bytes b"1";
        deserialize_byte_buf visit_bytes b"1";
        deserialize_unit visit_unit;
        deserialize_identifier visit_str "1";
        deserialize_ignored_any visit_unit;
    }

    fn deserialize_option<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        self.note("option");
        visitor.visit_some(self)
    }

    fn deserialize_unit_struct<V: Visitor<'de>>(self, name: &'static str, visitor: V) -> Result<V::Value, Error> {
        self.note(name);
        visitor.visit_unit()
    }

    fn deserialize_newtype_struct<V: Visitor<'de>>(self, name: &'static str, visitor: V) -> Result<V::Value, Error> {
        self.note(name);
        visitor.visit_newtype_struct(self)
    }

    fn deserialize_seq<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        self.note("sequence of");
        visitor.visit_seq(Parts::unnamed(self, 1))
    }

    fn deserialize_tuple<V: Visitor<'de>>(self, count: usize, visitor: V) -> Result<V::Value, Error> {
        self.note(format_args!("tuple of {count}"));
        visitor.visit_seq(Parts::unnamed(self, count))
    }

    fn deserialize_tuple_struct<V: Visitor<'de>>(
        self,
        name: &'static str,
        count: usize,
        visitor: V,
    ) -> Result<V::Value, Error> {
        self.note(name);
        self.deserialize_tuple(count, visitor)
    }

    fn deserialize_map<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        self.note("map of");
        visitor.visit_map(Parts::unnamed(self, 1))
    }

    fn deserialize_struct<V: Visitor<'de>>(
        self,
        name: &'static str,
        fields: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Error> {
        self.note(name);
        visitor.visit_seq(Parts { tracer: self, names: fields, left: fields.len() })
    }

    fn deserialize_enum<V: Visitor<'de>>(
        self,
        name: &'static str,
        variants: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Error> {
        let index = self.variant((name, variants));
        self.note(format_args!("{name}:{}", variants.join("|")));
        visitor.visit_enum(Choice { tracer: self, index })
    }
}

/// Fields of a struct, or elements without names.
struct Parts<'a> {
    tracer: &'a mut Tracer,
    names: &'static [&'static str],
    left: usize,
}

impl<'a> Parts<'a> {
    fn unnamed(tracer: &'a mut Tracer, count: usize) -> Self {
        Parts { tracer, names: &[], left: count }
    }
}

impl<'de> SeqAccess<'de> for Parts<'_> {
    type Error = Error;

    fn next_element_seed<T: DeserializeSeed<'de>>(&mut self, seed: T) -> Result<Option<T::Value>, Error> {
        if self.left == 0 {
            self.tracer.note("end");
            return Ok(None);
        }
        if let Some(name) = self.names.len().checked_sub(self.left).and_then(|at| self.names.get(at)) {
            self.tracer.note(name);
        }
        self.left -= 1;
        seed.deserialize(&mut *self.tracer).map(Some)
    }
}

impl<'de> MapAccess<'de> for Parts<'_> {
    type Error = Error;

    fn next_key_seed<K: DeserializeSeed<'de>>(&mut self, seed: K) -> Result<Option<K::Value>, Error> {
        self.next_element_seed(seed)
    }

    fn next_value_seed<V: DeserializeSeed<'de>>(&mut self, seed: V) -> Result<V::Value, Error> {
        seed.deserialize(&mut *self.tracer)
    }
}

/// One variant of an enumeration.
struct Choice<'a> {
    tracer: &'a mut Tracer,
    index: usize,
}

impl<'de> EnumAccess<'de> for Choice<'_> {
    type Error = Error;
    type Variant = Self;

    fn variant_seed<V: DeserializeSeed<'de>>(self, seed: V) -> Result<(V::Value, Self), Error> {
        let index: U32Deserializer<Error> = (self.index as u32).into_deserializer();
        Ok((seed.deserialize(index)?, self))
    }
}

impl<'de> VariantAccess<'de> for Choice<'_> {
    type Error = Error;

    fn unit_variant(self) -> Result<(), Error> {
        self.tracer.note(format_args!("variant {}", self.index));
        Ok(())
    }

    fn newtype_variant_seed<T: DeserializeSeed<'de>>(self, seed: T) -> Result<T::Value, Error> {
        self.tracer.note(format_args!("variant {}", self.index));
        seed.deserialize(self.tracer)
    }

    fn tuple_variant<V: Visitor<'de>>(self, count: usize, visitor: V) -> Result<V::Value, Error> {
        self.tracer.note(format_args!("variant {}", self.index));
        self.tracer.deserialize_tuple(count, visitor)
    }

    fn struct_variant<V: Visitor<'de>>(self, fields: &'static [&'static str], visitor: V) -> Result<V::Value, Error> {
        self.tracer.note(format_args!("variant {}", self.index));
        visitor.visit_seq(Parts { tracer: self.tracer, names: fields, left: fields.len() })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeMap;

    #[derive(Deserialize)]
    #[allow(dead_code)]
    enum Inner {
        Empty,
        Number(f32),
    }

    /// Names as in [`other`], one number wider, deep inside an enumeration.
    #[allow(dead_code)]
    mod one {
        #[derive(serde::Deserialize)]
        pub enum Outer {
            First,
            Second { inner: super::Inner, count: u32 },
        }
    }

    #[allow(dead_code)]
    mod other {
        #[derive(serde::Deserialize)]
        pub enum Outer {
            First,
            Second { inner: super::Inner, count: u64 },
        }
    }

    #[test]
    fn a_type_that_changes_under_the_same_name_changes_the_layout() {
        let (one, other) = (layout::<one::Outer>().unwrap(), layout::<other::Outer>().unwrap());
        assert_ne!(one, other);
        assert_eq!(one.replace("visit_u32", "visit_u64"), other);
        assert_eq!(one, layout::<one::Outer>().unwrap());
    }

    #[test]
    fn every_variant_is_visited_also_inside_of_others() {
        let text = layout::<one::Outer>().unwrap();
        for part in ["Outer:First|Second variant 0", "inner Inner:Empty|Number variant 0", "variant 1 visit_f32"] {
            assert!(text.contains(part), "{part} is missing in {text}");
        }
    }

    #[test]
    fn containers_tell_what_they_contain() {
        let text = layout::<(Option<Vec<[f64; 2]>>, BTreeMap<u32, bool>)>().unwrap();
        let parts = "option sequence of tuple of 2 visit_f64 visit_f64";
        assert!(text.contains(parts) && text.contains("map of visit_u32 visit_bool"), "{text}");
    }
}
