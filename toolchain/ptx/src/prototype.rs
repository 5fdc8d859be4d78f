//! Prototypes: what functions take and return.

use crate::Function;

/// What a function takes and returns: the types of its parameters and results.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Prototype {
    results: Vec<String>,
    parameters: Vec<String>,
}

impl Prototype {
    /// Reads what follows `.func`, `.entry` or `.callprototype`: `(results) name (parameters)`.
    pub(crate) fn read(head: &str) -> Option<Self> {
        let head = head.trim_start();
        let (results, rest) = match head.strip_prefix('(') {
            Some(rest) => rest.split_once(')')?,
            None => ("", head),
        };
        let parameters = rest.split_once('(')?.1.split_once(')')?.0;
        Some(Self { results: types(results)?, parameters: types(parameters)? })
    }
}

/// The types of parameters such as `.param .align 4 .b8 name[12]`.
fn types(parameters: &str) -> Option<Vec<String>> {
    let parameters = parameters.split(',').filter(|parameter| !parameter.trim().is_empty());
    let types = parameters.map(|parameter| {
        let words: Vec<_> = parameter.split_whitespace().collect();
        let (name, words) = words.split_last()?;
        Some(words.concat() + name.find('[').map_or("", |array| &name[array..]))
    });
    types.collect()
}

impl Function<'_> {
    /// The prototypes of the calls that it makes through addresses. `None` if one of them can't be read.
    ///
    /// ```
    /// let text = ".func (.param .b32 r) f(.param .b64 a) { }\n.func g() {\n\
    ///     prototype_0 : .callprototype (.param .b32 _) _ (.param .b64 _);\ncall (r0), %rd1, (p0), prototype_0;\n}";
    /// let module = optix_ptx::Module::read(text);
    /// let called = module.get("g").and_then(|g| g.called_prototypes());
    /// assert_eq!(called.as_deref(), Some(&[module.get("f").and_then(|f| f.prototype.clone()).unwrap()][..]));
    /// ```
    pub fn called_prototypes(&self) -> Option<Vec<Prototype>> {
        self.body().split(".callprototype").skip(1).map(Prototype::read).collect()
    }
}

#[cfg(test)]
mod tests {
    use crate::Module;

    #[test]
    fn prototypes_are_those_of_the_functions() {
        let text = "\
.visible .func  (.param .align 4 .b8 func_retval0[12]) __direct_callable__c(
	.param .b32 __direct_callable__c_param_0
)
{
	ret;
}
.visible .func __direct_callable__d()
{
	prototype_0 : .callprototype (.param .align 4 .b8 _[12]) _ (.param .b32 _);
	call (retval0), %rd1, (param0), prototype_0;
	prototype_1 : .callprototype (.param .align 4 .b8 _[8]) _ (.param .b32 _);
	call (retval0), %rd1, (param0), prototype_1;
	prototype_2 : .callprototype ()_ ();
	call %rd1, prototype_2;
	ret;
}
";
        let module = Module::read(text);
        let [c, d] = ["c", "d"].map(|name| module.get(&format!("__direct_callable__{name}")).unwrap());
        let called = d.called_prototypes().unwrap();
        let is = |of: &crate::Function<'_>| called.iter().map(|p| Some(p) == of.prototype.as_ref()).collect::<Vec<_>>();
        assert_eq!((is(c), is(d)), (vec![true, false, false], vec![false, false, true]));
        assert_eq!(c.called_prototypes(), Some(Vec::new()));
    }
}
