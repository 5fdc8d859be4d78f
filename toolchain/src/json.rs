//! A small JSON reader, for what `cargo metadata` prints, and writer, for `cargo optix`.
//!
//! This crate is a build dependency of every program with shaders, so reading a few fields must not cost those programs
//! a serialisation framework: `serde_json` alone takes longer to compile than all of this library.

use std::collections::BTreeMap;
use std::fmt::{self, Write};

/// A JSON value.
#[derive(Clone, Debug, PartialEq)]
pub enum Json {
    /// `null`
    Null,
    /// `true` or `false`
    Bool(bool),
    /// Any number.
    Number(f64),
    /// A string, its escapes resolved.
    String(String),
    /// `[..]`
    Array(Vec<Json>),
    /// `{..}`
    Object(BTreeMap<String, Json>),
}

impl Json {
    /// Reads a whole document; the error says what was expected and at which byte.
    ///
    /// ```
    /// use optix_toolchain::json::Json;
    /// let doc = Json::parse(r#"{"packages": [{"name": "libm"}]}"#)?;
    /// assert_eq!(doc.get("packages").items()[0].get("name").str(), Some("libm"));
    /// # Ok::<(), String>(())
    /// ```
    pub fn parse(text: &str) -> Result<Self, String> {
        let mut reader = Reader { text, at: 0, depth: 0 };
        let value = reader.value()?;
        reader.space();
        if reader.at < text.len() { Err(reader.expected("the end")) } else { Ok(value) }
    }

    /// An object.
    ///
    /// ```
    /// use optix_toolchain::json::Json;
    /// assert_eq!(Json::object([("a", Json::Number(1.0)), ("b", Json::Null)]).to_string(), r#"{"a":1,"b":null}"#);
    /// ```
    pub fn object<K: Into<String>>(members: impl IntoIterator<Item = (K, Json)>) -> Self {
        Self::Object(members.into_iter().map(|(key, value)| (key.into(), value)).collect())
    }

    /// The member `key`, or `Null` where there is none, so that look-ups chain.
    pub fn get(&self, key: &str) -> &Json {
        match self {
            Self::Object(members) => members.get(key).unwrap_or(&Self::Null),
            _ => &Self::Null,
        }
    }

    /// The elements of an array; of anything else, none.
    pub fn items(&self) -> &[Json] {
        match self {
            Self::Array(items) => items,
            _ => &[],
        }
    }

    /// The members of an object; of anything else, none.
    pub fn members(&self) -> impl Iterator<Item = (&str, &Json)> {
        let members = match self {
            Self::Object(members) => Some(members),
            _ => None,
        };
        members.into_iter().flatten().map(|(key, value)| (key.as_str(), value))
    }

    /// A number that is a size or an index.
    pub fn number(&self) -> Option<usize> {
        match self {
            // Exact: above 2^53 a double is no longer every integer.
            Self::Number(number) if (0.0..9e15).contains(number) && number.fract() == 0.0 => Some(*number as usize),
            _ => None,
        }
    }

    /// The text of a string.
    pub fn str(&self) -> Option<&str> {
        match self {
            Self::String(text) => Some(text),
            _ => None,
        }
    }
}

/// On one line.
impl fmt::Display for Json {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Null => f.write_str("null"),
            Self::Bool(value) => write!(f, "{value}"),
            Self::Number(number) if number.is_finite() => write!(f, "{number}"),
            Self::Number(_) => f.write_str("null"),
            Self::String(text) => write_string(text, f),
            Self::Array(items) => {
                f.write_str("[")?;
                for (i, item) in items.iter().enumerate() {
                    write!(f, "{}{item}", if i == 0 { "" } else { "," })?;
                }
                f.write_str("]")
            }
            Self::Object(members) => {
                f.write_str("{")?;
                for (i, (key, value)) in members.iter().enumerate() {
                    f.write_str(if i == 0 { "" } else { "," })?;
                    write_string(key, f)?;
                    write!(f, ":{value}")?;
                }
                f.write_str("}")
            }
        }
    }
}

fn write_string(text: &str, f: &mut fmt::Formatter<'_>) -> fmt::Result {
    f.write_char('"')?;
    for c in text.chars() {
        match c {
            '"' | '\\' => write!(f, "\\{c}")?,
            c if c.is_control() => write!(f, "\\u{:04x}", c as u32)?,
            c => f.write_char(c)?,
        }
    }
    f.write_char('"')
}

/// Deeper nesting than any cargo writes is refused, so that no input can exhaust the stack.
const MAX_DEPTH: usize = 128;

struct Reader<'a> {
    text: &'a str,
    at: usize,
    depth: usize,
}

impl<'a> Reader<'a> {
    fn rest(&self) -> &'a str {
        &self.text[self.at..]
    }

    fn expected(&self, what: &str) -> String {
        format!("expected {what} at byte {}", self.at)
    }

    fn space(&mut self) {
        self.at = self.text.len() - self.rest().trim_start_matches([' ', '\t', '\r', '\n']).len();
    }

    /// Takes `token`, with the white space before it, if it comes next.
    fn take(&mut self, token: &str) -> bool {
        self.space();
        let found = self.rest().starts_with(token);
        if found {
            self.at += token.len();
        }
        found
    }

    fn value(&mut self) -> Result<Json, String> {
        if self.take("{") {
            return self.nested(Self::object);
        }
        if self.take("[") {
            return self.nested(Self::array);
        }
        if self.take("\"") {
            return Ok(Json::String(self.string()?));
        }
        for (word, value) in [("null", Json::Null), ("true", Json::Bool(true)), ("false", Json::Bool(false))] {
            if self.take(word) {
                return Ok(value);
            }
        }
        let rest = self.rest();
        let length = rest.find(|c: char| !matches!(c, '0'..='9' | '+' | '-' | '.' | 'e' | 'E')).unwrap_or(rest.len());
        let number = rest[..length].parse().map_err(|_| self.expected("a value"))?;
        self.at += length;
        Ok(Json::Number(number))
    }

    fn nested(&mut self, read: impl FnOnce(&mut Self) -> Result<Json, String>) -> Result<Json, String> {
        self.depth += 1;
        if self.depth > MAX_DEPTH {
            return Err(self.expected("less nesting"));
        }
        let value = read(self);
        self.depth -= 1;
        value
    }

    fn object(&mut self) -> Result<Json, String> {
        let mut members = BTreeMap::new();
        if self.take("}") {
            return Ok(Json::Object(members));
        }
        loop {
            if !self.take("\"") {
                return Err(self.expected("a member name"));
            }
            let key = self.string()?;
            if !self.take(":") {
                return Err(self.expected("`:`"));
            }
            members.insert(key, self.value()?);
            if self.take("}") {
                return Ok(Json::Object(members));
            }
            if !self.take(",") {
                return Err(self.expected("`,` or `}`"));
            }
        }
    }

    fn array(&mut self) -> Result<Json, String> {
        let mut items = Vec::new();
        if self.take("]") {
            return Ok(Json::Array(items));
        }
        loop {
            items.push(self.value()?);
            if self.take("]") {
                return Ok(Json::Array(items));
            }
            if !self.take(",") {
                return Err(self.expected("`,` or `]`"));
            }
        }
    }

    /// The rest of a string whose opening quote is taken.
    fn string(&mut self) -> Result<String, String> {
        let mut text = String::new();
        loop {
            let rest = self.rest();
            let plain = rest.find(['"', '\\']).ok_or_else(|| self.expected("`\"`"))?;
            text.push_str(&rest[..plain]);
            self.at += plain + 1;
            if rest.as_bytes()[plain] == b'"' {
                return Ok(text);
            }
            text.push(self.escape()?);
        }
    }

    /// An escape whose backslash is taken.
    fn escape(&mut self) -> Result<char, String> {
        let kind = self.rest().chars().next().ok_or_else(|| self.expected("an escape"))?;
        self.at += kind.len_utf8();
        Ok(match kind {
            '"' | '\\' | '/' => kind,
            'b' => '\u{8}',
            'f' => '\u{c}',
            'n' => '\n',
            'r' => '\r',
            't' => '\t',
            'u' => {
                let first = self.hex()?;
                let code = if (0xd800..0xdc00).contains(&first) && self.rest().starts_with("\\u") {
                    self.at += 2;
                    let second = self.hex()?;
                    0x10000 + ((first - 0xd800) << 10) + (second.wrapping_sub(0xdc00) & 0x3ff)
                } else {
                    first
                };
                char::from_u32(code).ok_or_else(|| self.expected("a Unicode scalar value"))?
            }
            _ => return Err(self.expected("an escape")),
        })
    }

    fn hex(&mut self) -> Result<u32, String> {
        let digits = self.rest().get(..4).ok_or_else(|| self.expected("four hexadecimal digits"))?;
        let code = u32::from_str_radix(digits, 16).map_err(|_| self.expected("four hexadecimal digits"))?;
        self.at += 4;
        Ok(code)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reads_what_cargo_prints() {
        let doc =
            Json::parse(r#" {"a": [1, -2.5e3, true, null, {}], "b": {"c": "x\\\"\n\u00e9\ud83d\ude00"}, "d": []} "#)
                .expect("valid JSON");
        assert_eq!(doc.get("a").items().len(), 5);
        assert_eq!(doc.get("a").items()[1], Json::Number(-2500.0));
        assert_eq!(doc.get("b").get("c").str(), Some("x\\\"\n\u{e9}\u{1f600}"));
        assert_eq!(doc.get("missing").get("too"), &Json::Null);
        assert_eq!(Json::Number(12.0).number(), Some(12));
        assert_eq!([Json::Number(-1.0), Json::Number(0.5), Json::Null].map(|json| json.number()), [None; 3]);
    }

    #[test]
    fn refuses_what_is_not_json() {
        for bad in ["", "{", "[1,]", "{\"a\" 1}", "\"\\q\"", "\"\\ud800\"", "nul", "1 2", "\"open", "{\"a\":1,}"] {
            assert!(Json::parse(bad).is_err(), "{bad}");
        }
        assert!(Json::parse(&"[".repeat(100_000)).is_err());
    }
}
