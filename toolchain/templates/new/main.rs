/// The shaders compiled for the GPU; empty where no device compiler is installed.
const PTX: &str = include_str!(env!("OPTIX_PTX_{{IDENT}}_SHADERS"));

fn main() {
    println!("{{name}}: {} bytes of PTX", PTX.len());
}
