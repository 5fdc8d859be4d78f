//! Structs as the derives see them.

use crate::support::{Errors, mentions, name, ungroup};
use proc_macro2::{Span, TokenStream};
use quote::{ToTokens, quote};
use syn::spanned::Spanned;
use syn::{Attribute, Data, DeriveInput, Fields, Ident, Index, Member, Path, Type, Visibility};

/// A struct.
pub struct Struct {
    pub attrs: Vec<Attribute>,
    pub vis: Visibility,
    pub ident: Ident,
    pub form: Form,
    pub fields: Vec<Field>,
}

/// How a struct is written.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Form {
    Named,
    Tuple,
    Unit,
}

/// A field.
pub struct Field {
    pub attrs: Vec<Attribute>,
    pub vis: Visibility,
    pub member: Member,
    pub ty: Type,
    /// A view of device memory: by its type's name, or by `#[view]`.
    pub view: bool,
    /// `#[bound]`.
    pub bound: Option<Span>,
}

impl Field {
    /// The name, for messages and for `FIELDS`.
    pub fn name(&self) -> String {
        match &self.member {
            Member::Named(ident) => name(ident),
            Member::Unnamed(index) => index.index.to_string(),
        }
    }
}

/// The names of the view types; an alias of one needs `#[view]`.
const VIEWS: [&str; 13] = [
    "Slice",
    "SliceMut",
    "SliceMut2d",
    "Texture1d",
    "Texture2d",
    "Texture2dArray",
    "Texture3d",
    "TextureCube",
    "Traversable",
    "Instances",
    "TriangleVertices",
    "Callable",
    "Callables",
];

/// Whether the type is a view by its name, or an array of these.
fn is_view(ty: &Type) -> bool {
    match ungroup(ty) {
        Type::Path(path) => path.path.segments.last().is_some_and(|s| VIEWS.iter().any(|v| s.ident == v)),
        Type::Array(array) => is_view(&array.elem),
        _ => false,
    }
}

/// Whether the type is one view of elements by its name.
pub fn is_slice(ty: &Type) -> bool {
    const SLICES: [&str; 3] = ["Slice", "SliceMut", "SliceMut2d"];
    let Type::Path(path) = ungroup(ty) else { return false };
    path.path.segments.last().is_some_and(|s| SLICES.iter().any(|slice| s.ident == slice))
}

/// Whether the type is plain data by its name.
pub fn is_plain(ty: &Type) -> bool {
    const PLAIN: [&str; 29] = [
        "u8", "i8", "u16", "i16", "u32", "i32", "u64", "i64", "f32", "f64", "bool", "usize", "isize", "Vec2", "Vec3",
        "Vec3A", "Vec4", "UVec2", "UVec3", "UVec4", "IVec2", "IVec3", "IVec4", "Quat", "Mat3", "Mat4", "Affine3A",
        "char", "str",
    ];
    match ungroup(ty) {
        Type::Path(path) => path.path.segments.last().is_some_and(|s| PLAIN.iter().any(|p| s.ident == p)),
        Type::Array(array) => is_plain(&array.elem),
        _ => false,
    }
}

/// Whether nothing can be made of a field. What is wrong goes to `errors`.
fn is_no_field(field: &syn::Field, of: &Ident, what: &str, errors: &mut Errors) -> bool {
    if mentions(field.ty.to_token_stream(), "Self") {
        let message =
            format!("write `{of}` for `Self`: in the structs that are made of this one `Self` is another type");
        errors.at(&field.ty, message);
    } else if matches!(ungroup(&field.ty), Type::TraitObject(_) | Type::ImplTrait(_)) {
        errors.at(&field.ty, format!("{what} has fields of one size: this is no type of a value, but traits"));
    } else if let Type::FnPtr(function) = ungroup(&field.ty) {
        errors.at(
            function,
            format!("there are no function pointers on the device (guide 15.3): {what} holds a reference to a callable, `Callable<fn(..) -> ..>`"),
        );
    } else if let Some(unnamed) = field.ident.as_ref().filter(|ident| *ident == "_") {
        errors.at(unnamed, format!("a field of {what} has a name, by which programs read it"));
    } else {
        return false;
    }
    true
}

impl Struct {
    /// Reads a struct. `what` is what it is to become: "a payload", "an SBT record".
    pub fn parse(input: &DeriveInput, what: &str, tuples: bool, errors: &mut Errors) -> Option<Self> {
        let data = match &input.data {
            Data::Struct(data) => data,
            Data::Enum(data) => {
                errors.at(data.enum_token, format!("{what} is a struct, not an enum"));
                return None;
            }
            Data::Union(data) => {
                errors.at(data.union_token, format!("{what} is a struct, not a union"));
                return None;
            }
        };
        if !input.generics.params.is_empty() {
            let message = format!(
                "{what} can't be generic: its layout is fixed where it is declared; write one struct for each use"
            );
            errors.at(&input.generics, message);
            return None;
        }
        let form = match &data.fields {
            Fields::Named(_) => Form::Named,
            Fields::Unit => Form::Unit,
            Fields::Unnamed(_) if tuples => Form::Tuple,
            Fields::Unnamed(fields) => {
                errors
                    .at(fields, format!("{what} needs named fields: write `struct {} {{ name: Type }}`", input.ident));
                return None;
            }
        };
        if data.fields.iter().any(|field| is_no_field(field, &input.ident, what, errors)) {
            return None;
        }
        let fields = data.fields.iter().enumerate().map(|(i, field)| Field::parse(i, field, errors)).collect();
        Some(Self { attrs: input.attrs.clone(), vis: input.vis.clone(), ident: input.ident.clone(), form, fields })
    }

    /// The name.
    pub fn name(&self) -> String {
        name(&self.ident)
    }

    /// Whether any field is a view.
    pub fn has_views(&self) -> bool {
        self.fields.iter().any(|f| f.view)
    }

    /// Checks for a layout that host and device share.
    pub fn require_repr_c(&self, what: &str, errors: &mut Errors) {
        let repr = Repr::of(&self.attrs);
        if let Some(packed) = repr.packed {
            errors.at(packed, format!("{what} can't be packed: programs read its fields by reference"));
        } else if !repr.fixed {
            errors.at(
                &self.ident,
                format!(
                    "`{}` needs `#[repr(C)]`: host and device are compiled by different compilers, and without it each \
                     lays out the fields as it likes\n\nhelp: write `#[repr(C)]` above the struct",
                    self.ident
                ),
            );
        }
    }
}

impl Field {
    fn parse(index: usize, field: &syn::Field, errors: &mut Errors) -> Self {
        let flag = |word: &str, errors: &mut Errors| {
            let attribute = field.attrs.iter().find(|a| a.path().is_ident(word))?;
            if !matches!(attribute.meta, syn::Meta::Path(_)) {
                errors.at(attribute, format!("`#[{word}]` takes no arguments"));
            }
            Some(attribute.span())
        };
        let mut view = flag("view", errors).is_some();
        if view && is_plain(&field.ty) {
            errors.at(&field.ty, "`#[view]` is for views of device memory; this is plain data: remove it");
            view = false;
        }
        let bound = flag("bound", errors);
        let member = match &field.ident {
            Some(ident) => Member::Named(ident.clone()),
            None => Member::Unnamed(Index { index: index as u32, span: field.ty.span() }),
        };
        Self {
            attrs: field.attrs.clone(),
            vis: field.vis.clone(),
            member,
            ty: field.ty.clone(),
            view: view || is_view(&field.ty),
            bound,
        }
    }
}

const INTEGERS: [&str; 12] = ["u8", "i8", "u16", "i16", "u32", "i32", "u64", "i64", "u128", "i128", "usize", "isize"];

/// What `#[repr(..)]` says.
pub struct Repr {
    /// `C` or `transparent`.
    pub fixed: bool,
    /// The type of an enum's discriminants.
    pub integer: Option<Path>,
    /// `packed`.
    pub packed: Option<Path>,
}

impl Repr {
    /// Of these attributes. What can't be read is left to rustc.
    pub fn of(attributes: &[Attribute]) -> Self {
        let mut repr = Self { fixed: false, integer: None, packed: None };
        for attribute in attributes.iter().filter(|a| a.path().is_ident("repr")) {
            let _ = attribute.parse_nested_meta(|meta| {
                if meta.path.is_ident("C") || meta.path.is_ident("transparent") {
                    repr.fixed = true;
                } else if meta.path.is_ident("packed") {
                    repr.packed = Some(meta.path.clone());
                } else if INTEGERS.iter().any(|integer| meta.path.is_ident(integer)) {
                    repr.integer = Some(meta.path.clone());
                }
                if meta.input.peek(syn::token::Paren) {
                    let inner;
                    syn::parenthesized!(inner in meta.input);
                    inner.parse::<TokenStream>()?;
                }
                Ok(())
            });
        }
        repr
    }
}

/// The struct made of one expression per field. Braces build tuple and unit structs too.
pub fn construct(path: impl ToTokens, fields: &[Field], values: &[TokenStream]) -> TokenStream {
    let members = fields.iter().map(|f| &f.member);
    quote!(#path { #(#members: #values),* })
}
