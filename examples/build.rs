//! Compiles the examples' shader crates to PTX; without a device compiler the examples still run on the CPU.

fn main() {
    optix_toolchain::shaders("path-tracer/shaders");
}
