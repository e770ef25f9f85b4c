//! The text of a profile: a sum of calls such as `hole(position = 2, length = 5e-3) + file("rail.csv", every = 1)`.

use super::error::ProfileError;
use std::fmt::Display;

/// Longest text [characters]: longer profiles belong into a file. It bounds the cost of evaluating all features.
const LONGEST: usize = 20_000;

/// A feature as it is written: its name and its arguments.
#[derive(Clone, Debug, PartialEq)]
pub struct FeatureCall {
    /// Name of the feature.
    pub name: String,
    /// Column in the text, from 1.
    pub column: usize,
    /// Arguments: name, none for a text that stands alone, and value.
    pub given: Vec<(Option<String>, ArgumentValue)>,
}

impl FeatureCall {
    /// Number that is given under a name.
    pub fn number(&self, name: &str) -> Option<f64> {
        self.given.iter().find_map(|(given, value)| match value {
            ArgumentValue::Number(number) if given.as_deref() == Some(name) => Some(*number),
            _ => None,
        })
    }
}

/// A value as it is written.
#[derive(Clone, Debug, PartialEq)]
pub enum ArgumentValue {
    /// `5e-3`
    Number(f64),
    /// `fresh`
    Word(String),
    /// `"rail.csv"`
    Text(String),
    /// `[17.1, 15, 13]`
    List(Vec<f64>),
}

/// A piece of the text.
#[derive(Clone, Debug, PartialEq)]
enum Token {
    Number(f64),
    Word(String),
    Text(String),
    Sign(char),
}

/// The features of a text; none if it is blank. A bare name of a file is `file("name")`.
pub fn calls(text: &str) -> Result<Vec<FeatureCall>, ProfileError> {
    let bare = text.trim();
    if bare.is_empty() {
        return Ok(Vec::new());
    }
    if bare.to_lowercase().ends_with(".csv") {
        let given = vec![(None, ArgumentValue::Text(bare.to_owned()))];
        return Ok(vec![FeatureCall { name: "file".to_owned(), column: 1, given }]);
    }
    if let Some((at, _)) = text.char_indices().nth(LONGEST) {
        let found = text[at..].chars().next().unwrap_or_default();
        return Err(unexpected(LONGEST, "the end (longer profiles belong into a .csv file)", found));
    }
    let mut reader = Reader { tokens: tokens(text)?, next: 0, end: text.chars().count() + 1 };
    let mut calls = vec![reader.call()?];
    while !reader.is_done() {
        reader.expect('+', "+ or the end")?;
        calls.push(reader.call()?);
    }
    Ok(calls)
}

/// Splits a text into its pieces, each with its column.
fn tokens(text: &str) -> Result<Vec<(usize, Token)>, ProfileError> {
    let chars: Vec<char> = text.chars().collect();
    let mut found = Vec::new();
    let mut at = 0;
    while at < chars.len() {
        let first = chars[at];
        let run = |from: usize, part: &dyn Fn(usize) -> bool| (from..chars.len()).find(|&i| !part(i));
        let until = |end: Option<usize>| end.unwrap_or(chars.len());
        let (token, next) = if first.is_whitespace() {
            at += 1;
            continue;
        } else if first.is_alphabetic() || first == '_' {
            let end = until(run(at, &|i| chars[i].is_alphanumeric() || chars[i] == '_'));
            (Token::Word(chars[at..end].iter().collect()), end)
        } else if first == '"' {
            let end = until(run(at + 1, &|i| chars[i] != '"'));
            if end == chars.len() {
                return Err(unexpected(at, "a closing \" after this one", first));
            }
            (Token::Text(chars[at + 1..end].iter().collect()), end + 1)
        } else if number_starts(&chars, at) {
            let after_e = |i: usize| i > at && matches!(chars[i - 1], 'e' | 'E');
            let sign = |i: usize| matches!(chars[i], '+' | '-') && (i == at || after_e(i));
            let end = until(run(at, &|i| chars[i].is_alphanumeric() || chars[i] == '.' || sign(i)));
            let word: String = chars[at..end].iter().collect();
            match word.parse::<f64>() {
                Ok(number) if number.is_finite() => (Token::Number(number), end),
                _ => return Err(unexpected(at, "a finite number without a unit", word)),
            }
        } else {
            (Token::Sign(first), at + 1)
        };
        found.push((at + 1, token));
        at = next;
    }
    Ok(found)
}

/// Beginning of a number: a digit, a point, or a minus before one.
fn number_starts(chars: &[char], at: usize) -> bool {
    let digit = |i: usize| chars.get(i).is_some_and(|c| c.is_ascii_digit() || *c == '.');
    digit(at) || (chars[at] == '-' && digit(at + 1))
}

/// Something at index `at` of the text that should not stand there.
fn unexpected(at: usize, expected: &str, found: impl Display) -> ProfileError {
    ProfileError::syntax(at + 1, expected, found)
}

/// The pieces of a text, read one after the other.
struct Reader {
    tokens: Vec<(usize, Token)>,
    next: usize,
    end: usize,
}

impl Reader {
    fn is_done(&self) -> bool {
        self.next >= self.tokens.len()
    }

    fn is_sign(&self, sign: char) -> bool {
        self.tokens.get(self.next).is_some_and(|(_, token)| *token == Token::Sign(sign))
    }

    fn take(&mut self) -> Option<(usize, Token)> {
        let token = self.tokens.get(self.next).cloned();
        self.next += 1;
        token
    }

    /// An error about the piece that was taken.
    fn wrong<T>(&self, token: Option<(usize, Token)>, expected: &'static str) -> Result<T, ProfileError> {
        let (column, found) = match token {
            None => (self.end, "the end".to_owned()),
            Some((column, Token::Number(number))) => (column, format!("{number}")),
            Some((column, Token::Word(word))) => (column, word),
            Some((column, Token::Text(text))) => (column, format!("\"{text}\"")),
            Some((column, Token::Sign(sign))) => (column, sign.to_string()),
        };
        Err(ProfileError::syntax(column, expected, found))
    }

    fn expect(&mut self, sign: char, expected: &'static str) -> Result<(), ProfileError> {
        match self.take() {
            Some((_, Token::Sign(found))) if found == sign => Ok(()),
            other => self.wrong(other, expected),
        }
    }

    /// `name(parameter = value, …)`
    fn call(&mut self) -> Result<FeatureCall, ProfileError> {
        let (column, name) = match self.take() {
            Some((column, Token::Word(name))) => (column, name),
            other => return self.wrong(other, "the name of a feature"),
        };
        self.expect('(', "( after the name of the feature")?;
        let mut given = Vec::new();
        while !self.is_sign(')') {
            if !given.is_empty() {
                self.expect(',', ", or )")?;
            }
            given.push(self.parameter()?);
        }
        self.next += 1;
        Ok(FeatureCall { name, column, given })
    }

    /// `name = value`, or a text alone.
    fn parameter(&mut self) -> Result<(Option<String>, ArgumentValue), ProfileError> {
        match self.take() {
            Some((_, Token::Text(text))) => Ok((None, ArgumentValue::Text(text))),
            Some((_, Token::Word(name))) => {
                self.expect('=', "= after the name of the parameter")?;
                Ok((Some(name), self.value()?))
            }
            other => self.wrong(other, "the name of a parameter"),
        }
    }

    fn value(&mut self) -> Result<ArgumentValue, ProfileError> {
        match self.take() {
            Some((_, Token::Number(number))) => Ok(ArgumentValue::Number(number)),
            Some((_, Token::Word(word))) => Ok(ArgumentValue::Word(word)),
            Some((_, Token::Text(text))) => Ok(ArgumentValue::Text(text)),
            Some((_, Token::Sign('['))) => self.list(),
            other => self.wrong(other, "a value"),
        }
    }

    /// Numbers up to the closing bracket.
    fn list(&mut self) -> Result<ArgumentValue, ProfileError> {
        let mut numbers = Vec::new();
        while !self.is_sign(']') {
            if !numbers.is_empty() {
                self.expect(',', ", or ]")?;
            }
            match self.take() {
                Some((_, Token::Number(number))) => numbers.push(number),
                other => return self.wrong(other, "a number"),
            }
        }
        self.next += 1;
        Ok(ArgumentValue::List(numbers))
    }
}
