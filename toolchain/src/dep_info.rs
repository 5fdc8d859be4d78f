//! Cargo's dep-info files: which sources an artifact was made from.

use std::path::PathBuf;

/// The prerequisites in a dep-info file, in make's syntax: `target: file file ..`, spaces in names escaped.
pub(crate) fn sources(text: &str) -> Vec<PathBuf> {
    let mut files = Vec::new();
    for line in text.lines() {
        let Some((_, list)) = line.split_once(": ") else {
            continue;
        };
        let mut name = String::new();
        let mut chars = list.chars().peekable();
        while let Some(c) = chars.next() {
            match c {
                '\\' if chars.peek() == Some(&' ') => name.extend(chars.next()),
                ' ' => files.push(PathBuf::from(std::mem::take(&mut name))),
                _ => name.push(c),
            }
        }
        files.push(PathBuf::from(name));
    }
    files.retain(|file| !file.as_os_str().is_empty());
    files
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_may_hold_spaces() {
        let files = sources("/t/a.a: /s/lib.rs /s/my\\ file.rs\n");
        assert_eq!(files, [PathBuf::from("/s/lib.rs"), PathBuf::from("/s/my file.rs")]);
        assert_eq!(sources("/t/a.a:\n"), [] as [PathBuf; 0]);
    }
}
