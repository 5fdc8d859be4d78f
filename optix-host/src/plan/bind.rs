//! Launch parameters that are constants of a pipeline (guide 6.5.1).

use crate::error::LaunchError;
use optix_device_rs::params::Field;

/// A bound parameter.
#[derive(Clone, Debug)]
pub(crate) struct BoundValue {
    pub field: Field,
    pub bytes: Vec<u8>,
}

impl BoundValue {
    /// Whether a launch's parameters have the bound value (guide 6.5.1: they must).
    pub fn check(&self, params: &[u8]) -> Result<(), LaunchError> {
        let given = &params[self.field.offset..self.field.offset + self.field.size];
        if given == self.bytes {
            Ok(())
        } else {
            let (parameter, given, bound) = (self.field.name, show(given), self.value());
            Err(LaunchError::BoundValue { parameter, given, bound })
        }
    }

    /// The value for messages.
    pub fn value(&self) -> String {
        show(&self.bytes)
    }
}

/// Shows little-endian bytes as a hexadecimal number, and 32 bits also as a decimal one.
fn show(bytes: &[u8]) -> String {
    let hex: String = bytes.iter().rev().map(|b| format!("{b:02x}")).collect();
    match <[u8; 4]>::try_from(bytes) {
        Ok(word) => format!("0x{hex} = {}", u32::from_le_bytes(word)),
        Err(_) => format!("0x{hex}"),
    }
}
