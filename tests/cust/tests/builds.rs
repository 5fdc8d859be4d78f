//! The feature `cust` of optix-host compiles and links with the stub of a CUDA toolkit; the test `cust` runs with it as far
//! as it does without a GPU.

use std::path::Path;
use std::process::Command;

#[test]
fn with_a_stub_for_a_toolkit() {
    let stub = Path::new(env!("CARGO_TARGET_TMPDIR")).join("cuda-stub");
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("stub.sh");
    assert!(Command::new(script).arg(&stub).status().expect("bash runs").success());
    let mut test = Command::new(env!("CARGO"));
    test.args(["test", "--package", "optix-cust-tests", "--features", "cust", "--test", "cust"]);
    let status = test
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .env("CUDA_LIBRARY_PATH", &stub)
        .env("LD_LIBRARY_PATH", stub.join("lib64"))
        // The stub is in the driver's place.
        .env_remove("OPTIX_TEST_GPU")
        .status();
    assert!(status.expect("cargo runs").success());
}
