fn main() {
    let path = std::env::args().nth(1).unwrap();
    let t = std::time::Instant::now();
    match optix_toolchain::Shaders::new(&path).quiet(false).compile_in("/tmp/exp/area") {
        Ok(b) => println!("{} {:?} {:?} {:#?}", b.ptx.display(), b.entries, b.functions, b.inputs),
        Err(e) => eprintln!("error: {e}"),
    }
    println!("{:?}", t.elapsed());
}
