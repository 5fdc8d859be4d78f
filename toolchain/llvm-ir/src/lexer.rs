//! Splits LLVM IR into tokens.

use super::unknown::Unknown;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Token<'a> {
    /// A keyword, a type's name or a number.
    Word(&'a str),
    /// `name:`, at the start of a block.
    Label(&'a str),
    /// `%name`
    Local(&'a str),
    /// `@name`
    Global(&'a str),
    /// `!5`, `!name`, or `!` alone.
    Metadata(&'a str),
    /// `#5`
    Group(&'a str),
    /// `$name`
    Comdat(&'a str),
    /// The text between quotation marks, with its escapes.
    Text(&'a str),
    /// `c"..."`
    Bytes(&'a str),
    Punctuation(char),
    Ellipsis,
    End,
}

/// The tokens, each with its line, counted from 0.
pub(super) fn tokens(text: &str) -> Result<Vec<(Token<'_>, usize)>, (Unknown, usize)> {
    let mut lexer = Lexer { text, at: 0, line: 0 };
    let mut tokens = Vec::new();
    loop {
        let line = lexer.skip_space();
        let token = lexer.next().map_err(|reason| (Unknown::new(reason), line))?;
        tokens.push((token, line));
        if token == Token::End {
            return Ok(tokens);
        }
    }
}

struct Lexer<'a> {
    text: &'a str,
    at: usize,
    line: usize,
}

impl<'a> Lexer<'a> {
    fn rest(&self) -> &'a str {
        &self.text[self.at..]
    }

    /// Skips space and comments; returns the line of what follows.
    fn skip_space(&mut self) -> usize {
        while let Some(c) = self.rest().chars().next() {
            match c {
                ';' => self.at += self.rest().find('\n').unwrap_or(self.rest().len()),
                '\n' => {
                    self.line += 1;
                    self.at += 1;
                }
                c if c.is_whitespace() => self.at += c.len_utf8(),
                _ => break,
            }
        }
        self.line
    }

    fn next(&mut self) -> Result<Token<'a>, String> {
        let rest = self.rest();
        let Some(first) = rest.chars().next() else { return Ok(Token::End) };
        let sigil: Option<fn(&'a str) -> Token<'a>> = match first {
            '%' => Some(Token::Local),
            '@' => Some(Token::Global),
            '!' => Some(Token::Metadata),
            '#' => Some(Token::Group),
            '$' => Some(Token::Comdat),
            _ => None,
        };
        if let Some(token) = sigil {
            self.at += 1;
            if first != '!' && self.rest().starts_with('"') {
                return self.quoted().map(token);
            }
            let name = self.word();
            return if name.is_empty() && first != '!' { Err(format!("a lone `{first}`")) } else { Ok(token(name)) };
        }
        if first == '"' {
            let text = self.quoted()?;
            return Ok(if self.eat(":") { Token::Label(text) } else { Token::Text(text) });
        }
        if rest.starts_with("c\"") {
            self.at += 1;
            return self.quoted().map(Token::Bytes);
        }
        if self.eat("...") {
            return Ok(Token::Ellipsis);
        }
        match self.word() {
            "" => {
                self.at += first.len_utf8();
                Ok(Token::Punctuation(first))
            }
            word if self.eat(":") => Ok(Token::Label(word)),
            word => Ok(Token::Word(word)),
        }
    }

    fn eat(&mut self, text: &str) -> bool {
        let found = self.rest().starts_with(text);
        self.at += if found { text.len() } else { 0 };
        found
    }

    fn word(&mut self) -> &'a str {
        let is_part = |c: char| c.is_ascii_alphanumeric() || matches!(c, '_' | '.' | '$' | '-' | '+' | '\\');
        let rest = self.rest();
        let word = &rest[..rest.find(|c| !is_part(c)).unwrap_or(rest.len())];
        self.at += word.len();
        word
    }

    /// Reads the text between quotation marks; the opening one comes next.
    fn quoted(&mut self) -> Result<&'a str, String> {
        let inner = &self.rest()[1..];
        let end = inner.find('"').ok_or("a text without its end")?;
        self.at += end + 2;
        self.line += inner[..end].matches('\n').count();
        Ok(&inner[..end])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_kind_of_token_is_told_apart() {
        let text = "\"a b\": ; comment\n  %1 = call i32 @\"f g\"(...), !dbg !5 #3 c\"x\\00\" 1.5e+00 -4 $c";
        let tokens: Vec<_> = tokens(text).expect("tokens").into_iter().map(|(token, _)| token).collect();
        use Token::*;
        let expected = [
            Label("a b"),
            Local("1"),
            Punctuation('='),
            Word("call"),
            Word("i32"),
            Global("f g"),
            Punctuation('('),
            Ellipsis,
            Punctuation(')'),
            Punctuation(','),
            Metadata("dbg"),
            Metadata("5"),
            Group("3"),
            Bytes("x\\00"),
            Word("1.5e+00"),
            Word("-4"),
            Comdat("c"),
            End,
        ];
        assert_eq!(tokens, expected);
    }

    #[test]
    fn a_text_needs_its_end() {
        assert!(tokens("@\"x").is_err() && tokens("% ").is_err());
    }
}
