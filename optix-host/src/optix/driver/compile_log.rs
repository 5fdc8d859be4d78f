//! The text of compiling calls (guide 6).

/// A buffer for the text of a compiling call. The driver writes what fits, and its full length.
pub(super) struct CompileLog {
    buffer: Vec<u8>,
    size: usize,
}

impl CompileLog {
    /// Enough for the compile feedback of a large module at log level 4.
    const SIZE: usize = 64 << 10;

    pub(super) fn new() -> Self {
        Self { buffer: vec![0; Self::SIZE], size: Self::SIZE }
    }

    /// The buffer and its in-out size, valid until the next use of `self`.
    pub(super) fn parts(&mut self) -> (*mut std::ffi::c_char, *mut usize) {
        (self.buffer.as_mut_ptr().cast(), &raw mut self.size)
    }

    pub(super) fn text(&self) -> String {
        let end = self.buffer.iter().position(|&byte| byte == 0).unwrap_or(self.buffer.len());
        let mut text = String::from_utf8_lossy(&self.buffer[..end]).trim_end().to_owned();
        if self.size > self.buffer.len() {
            text.push_str(&format!("\n[{} bytes of {} shown]", end, self.size));
        }
        text
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_truncated_compile_log_says_so() {
        let mut log = CompileLog::new();
        log.buffer.fill(b'x');
        log.size = CompileLog::SIZE + 5;
        assert!(log.text().ends_with(&format!("[{0} bytes of {1} shown]", CompileLog::SIZE, CompileLog::SIZE + 5)));
        let mut log = CompileLog::new();
        let (buffer, size) = log.parts();
        // SAFETY: the buffer is longer than this and `size` is valid for a write.
        unsafe {
            std::ptr::copy_nonoverlapping(c"warning\n".as_ptr(), buffer, 9);
            size.write(9);
        }
        assert_eq!(log.text(), "warning");
    }
}
