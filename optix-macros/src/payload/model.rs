//! A payload: who reads and who writes each field.

use crate::shape::{Field, Struct};
use crate::support::Errors;
use proc_macro2::Span;
use syn::punctuated::Punctuated;
use syn::{Attribute, Ident};

/// Who takes part in a ray.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Party {
    Caller,
    ClosestHit,
    Miss,
    AnyHit,
    Intersection,
}

impl Party {
    pub const ALL: [Self; 5] = [Self::Caller, Self::ClosestHit, Self::Miss, Self::AnyHit, Self::Intersection];

    /// As in `read(..)` and `write(..)`.
    pub fn keyword(self) -> &'static str {
        match self {
            Self::Caller => "caller",
            Self::ClosestHit => "closesthit",
            Self::Miss => "miss",
            Self::AnyHit => "anyhit",
            Self::Intersection => "intersection",
        }
    }

    /// As in `RadianceAtClosestHit`.
    pub fn suffix(self) -> &'static str {
        match self {
            Self::Caller => "Caller",
            Self::ClosestHit => "ClosestHit",
            Self::Miss => "Miss",
            Self::AnyHit => "AnyHit",
            Self::Intersection => "Intersection",
        }
    }

    /// In a sentence.
    pub fn phrase(self) -> &'static str {
        match self {
            Self::Caller => "the caller of `trace`",
            Self::ClosestHit => "the closest-hit program",
            Self::Miss => "the miss program",
            Self::AnyHit => "the any-hit program",
            Self::Intersection => "the intersection program",
        }
    }

    fn parse(ident: &Ident) -> syn::Result<Self> {
        if let Some(party) = Self::ALL.into_iter().find(|p| ident == p.keyword()) {
            return Ok(party);
        }
        let guess = match ident.to_string().to_lowercase().replace('_', "").as_str() {
            "closesthit" | "closest" | "ch" | "hit" => Some(Self::ClosestHit),
            "anyhit" | "any" | "ah" => Some(Self::AnyHit),
            "raygen" | "rg" | "trace" => Some(Self::Caller),
            "ms" | "missed" => Some(Self::Miss),
            "is" | "intersect" | "intersections" => Some(Self::Intersection),
            _ => None,
        };
        let hint = guess.map(|p| format!(" (did you mean `{}`?)", p.keyword())).unwrap_or_default();
        Err(syn::Error::new(
            ident.span(),
            format!(
                "`{ident}` takes no part in a ray{hint}: the parties are `caller`, `closesthit`, `miss`, `anyhit` and \
                 `intersection`"
            ),
        ))
    }
}

/// The parties of one list, each with the word that names it.
#[derive(Default)]
pub struct Parties(pub Vec<(Party, Span)>);

impl Parties {
    pub fn has(&self, party: Party) -> bool {
        self.span(party).is_some()
    }
    /// In a sentence.
    pub fn phrase(&self) -> String {
        let phrases: Vec<&str> = self.0.iter().map(|(party, _)| party.phrase()).collect();
        match phrases.split_last() {
            None => "nobody".to_owned(),
            Some((last, [])) => (*last).to_owned(),
            Some((last, others)) => format!("{} and {last}", others.join(", ")),
        }
    }
    pub fn span(&self, party: Party) -> Option<Span> {
        self.0.iter().find(|(p, _)| *p == party).map(|(_, span)| *span)
    }
}

/// Who reads and who writes a field.
pub struct Access {
    pub read: Parties,
    pub write: Parties,
    /// False where the attribute was missing or could not be understood: nothing can be proved then.
    pub complete: bool,
}

/// How a payload gets from party to party.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Transport {
    #[default]
    Registers,
    Pointer,
}

impl Transport {
    /// Reads `#[payload(transport = ..)]` of a struct.
    fn of(attributes: &[Attribute], errors: &mut Errors) -> Self {
        let mut chosen = None;
        for attribute in attributes.iter().filter(|a| a.path().is_ident("payload")) {
            let result = attribute.parse_nested_meta(|meta| {
                if !meta.path.is_ident("transport") {
                    return Err(meta.error(
                        "above a struct, `#[payload(..)]` says how the payload travels: `transport = registers` or `transport \
                         = pointer`; who reads and writes is said above each field",
                    ));
                }
                let value: Ident = meta.value()?.parse()?;
                let transport = match value.to_string().as_str() {
                    "registers" => Self::Registers,
                    "pointer" => Self::Pointer,
                    _ => {
                        let message = format!(
                            "a payload does not travel by `{value}`: write `registers`, for up to 32 words, or `pointer`, for \
                             any number in the caller's memory"
                        );
                        return Err(syn::Error::new(value.span(), message));
                    }
                };
                if chosen.replace(transport).is_some() {
                    return Err(meta.error("`transport` is there twice: a payload travels in one way"));
                }
                Ok(())
            });
            errors.keep(result);
        }
        chosen.unwrap_or_default()
    }
}

pub struct Payload {
    pub shape: Struct,
    pub transport: Transport,
    pub access: Vec<Access>,
}

impl Payload {
    pub fn new(shape: Struct, errors: &mut Errors) -> Self {
        let access = shape.fields.iter().map(|field| Access::parse(field, errors)).collect();
        let transport = Transport::of(&shape.attrs, errors);
        Self { shape, transport, access }
    }

    /// Indices of the fields in one party's part.
    pub fn part(&self, party: Party, reads: bool) -> Vec<usize> {
        (0..self.access.len())
            .filter(|&i| {
                let access = &self.access[i];
                if reads { access.read.has(party) } else { access.write.has(party) }
            })
            .collect()
    }
}

impl Access {
    fn parse(field: &Field, errors: &mut Errors) -> Self {
        let mut access = Self { read: Parties::default(), write: Parties::default(), complete: true };
        let name = field.name();
        let mut attributes = field.attrs.iter().filter(|a| a.path().is_ident("payload"));
        let Some(attribute) = attributes.next() else {
            errors.at(
                &field.member,
                format!(
                    "field `{name}` does not say who reads and writes it\n\nhelp: put \
                     `#[payload(write(closesthit, miss), read(caller))]`, or what applies, above the field; the parties \
                     are `caller`, `closesthit`, `miss`, `anyhit` and `intersection`"
                ),
            );
            access.complete = false;
            return access;
        };
        let mut seen: Vec<&str> = Vec::new();
        let mut broken = false;
        for second in attributes {
            broken = true;
            errors.at(second, format!("field `{name}` has `#[payload(..)]` twice: write one, with all parties"));
        }
        let result = attribute.parse_nested_meta(|meta| {
            let word = if meta.path.is_ident("read") {
                "read"
            } else if meta.path.is_ident("write") {
                "write"
            } else if meta.path.is_ident("transport") {
                return Err(meta.error("all fields of a payload travel in one way: put `transport` above the struct"));
            } else {
                return Err(meta.error("expected `write(..)` or `read(..)`, with the parties in the brackets"));
            };
            if seen.contains(&word) {
                return Err(meta.error(format!("`{word}` is there twice: list all parties in one")));
            }
            seen.push(word);
            if !meta.input.peek(syn::token::Paren) {
                return Err(meta.error(format!("expected the parties in brackets: `{word}(caller)`")));
            }
            let content;
            syn::parenthesized!(content in meta.input);
            let list = if word == "read" { &mut access.read } else { &mut access.write };
            let idents = Punctuated::<Ident, syn::Token![,]>::parse_terminated(&content)?;
            if idents.is_empty() {
                broken = true;
                errors.at(&meta.path, format!("`{word}()` names nobody: name a party, such as `{word}(caller)`"));
            }
            for ident in idents {
                match Party::parse(&ident) {
                    Ok(party) if list.has(party) => {
                        errors.at(&ident, format!("`{ident}` is in `{word}(..)` of field `{name}` twice"));
                    }
                    Ok(party) => list.0.push((party, ident.span())),
                    Err(error) => {
                        broken = true;
                        errors.push(error);
                    }
                }
            }
            Ok(())
        });
        if let Err(error) = result {
            broken = true;
            errors.push(error);
        }
        access.complete = !broken;
        if !broken {
            for word in ["write", "read"].into_iter().filter(|w| !seen.contains(w)) {
                access.complete = false;
                let (why, way) = if word == "write" {
                    (
                        "nobody writes it",
                        "so nobody has a value to read: add `write(..)`, with `caller` for a start value",
                    )
                } else {
                    ("nobody reads it", "so it takes registers for nothing: add `read(..)`, or remove the field")
                };
                errors.at(attribute, format!("field `{name}`: {why}, {way}"));
            }
        }
        access
    }
}
