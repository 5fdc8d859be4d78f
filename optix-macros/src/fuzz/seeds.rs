//! Inputs that compile.

use super::MACROS;
use proc_macro2::TokenStream;
use quote::ToTokens;

/// What macros are given in the programs that compile: name, arguments, item.
#[derive(Default)]
pub struct Seeds(pub Vec<(&'static str, TokenStream, TokenStream)>);

impl Seeds {
    pub fn read() -> Self {
        let mut seeds = Self::default();
        for folder in ["ui/pass", "ui/common"] {
            let folder = format!("{}/../tests/macros/{folder}", env!("CARGO_MANIFEST_DIR"));
            let mut files: Vec<_> =
                std::fs::read_dir(folder).expect("the suite").map(|f| f.expect("a file").path()).collect();
            files.sort();
            for file in files {
                let text = std::fs::read_to_string(&file).expect("a program");
                seeds.items(syn::parse_file(&text).expect("a program that compiles").items);
            }
        }
        seeds
    }

    fn items(&mut self, items: Vec<syn::Item>) {
        for item in items {
            match item {
                syn::Item::Mod(module) => self.items(module.content.map(|(_, items)| items).unwrap_or_default()),
                syn::Item::Macro(makro) => {
                    let name = makro.mac.path.segments.last().map(|s| s.ident.to_string());
                    self.add(&name.unwrap_or_default(), TokenStream::new(), makro.mac.tokens);
                }
                syn::Item::Struct(syn::ItemStruct { ref attrs, .. })
                | syn::Item::Enum(syn::ItemEnum { ref attrs, .. }) => {
                    let tokens = item.to_token_stream();
                    for attribute in attrs {
                        self.attribute(attribute, &tokens);
                    }
                }
                syn::Item::Fn(mut item) => {
                    let attributes = std::mem::take(&mut item.attrs);
                    for attribute in &attributes {
                        self.attribute(attribute, &item.to_token_stream());
                    }
                }
                _ => {}
            }
        }
    }

    fn attribute(&mut self, attribute: &syn::Attribute, item: &TokenStream) {
        let name = attribute.path().segments.last().map(|s| s.ident.to_string()).unwrap_or_default();
        match &attribute.meta {
            syn::Meta::List(list) if name == "derive" => {
                for word in list.tokens.clone() {
                    self.add(&word.to_string(), TokenStream::new(), item.clone());
                }
            }
            syn::Meta::List(list) => self.add(&name, list.tokens.clone(), item.clone()),
            _ => self.add(&name, TokenStream::new(), item.clone()),
        }
    }

    fn add(&mut self, name: &str, arguments: TokenStream, item: TokenStream) {
        if let Some((name, _)) = MACROS.iter().find(|(known, _)| *known == name) {
            self.0.push((name, arguments, item));
        }
    }
}
