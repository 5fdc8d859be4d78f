//! The functions of a module, and which call which.

use crate::ptx::body::Body;
use crate::ptx::calls::{Call, calls, demangled};

/// A function with its calls.
pub(super) struct Function<'a> {
    pub body: &'a Body<'a>,
    pub calls: Vec<Call<'a>>,
}

impl Function<'_> {
    /// The item with this function, if it is not the item's own entry.
    pub fn place(&self, item: &str) -> String {
        if self.body.is_entry {
            item.to_string()
        } else {
            format!("{item}, in `{}`, which it calls", demangled(self.body.name))
        }
    }
}

/// All functions of a module.
pub(super) struct Code<'a>(pub Vec<Function<'a>>);

impl<'a> Code<'a> {
    pub fn new(bodies: &'a [Body<'a>]) -> Self {
        Self(bodies.iter().map(|body| Function { body, calls: calls(body) }).collect())
    }

    pub fn get(&self, name: &str) -> Option<&Function<'a>> {
        self.0.iter().find(|function| function.body.name == name)
    }

    /// An entry, and every function that it calls or that those call.
    pub fn reached(&self, entry: &str) -> Vec<&Function<'a>> {
        let mut reached: Vec<&Function<'a>> = self.get(entry).into_iter().collect();
        let mut at = 0;
        while let Some(function) = reached.get(at) {
            for callee in function.calls.iter().filter_map(|call| self.get(call.function)).collect::<Vec<_>>() {
                if !reached.iter().any(|known| known.body.name == callee.body.name) {
                    reached.push(callee);
                }
            }
            at += 1;
        }
        reached
    }
}
