//! Finds libNVVM and libdevice.

use std::path::{Path, PathBuf};
use std::process::Command;

/// The environment variable that names the libNVVM to use.
pub const CHOICE: &str = "OPTIX_NVVM";

/// Every libNVVM in the places where `cargo optix setup`, CUDA toolkits, drivers and Python wheels put it, in the order
/// of preference. If `OPTIX_NVVM` names one, only that. `cache` is the folder that `cargo optix setup --nvvm` installs
/// into.
pub fn libraries(cache: Option<&Path>) -> Vec<PathBuf> {
    if let Some(chosen) = std::env::var_os(CHOICE).filter(|chosen| !chosen.is_empty()) {
        return vec![chosen.into()];
    }
    let mut files: Vec<PathBuf> = Vec::new();
    for path in
        folders(cache).iter().flat_map(|dir| ["libnvvm.so", "libnvidia-nvvm.so"].map(|name| list(dir, name))).flatten()
    {
        // Symbolic links are followed, because the real path tells the version of the toolkit.
        if let Ok(path) = path.canonicalize()
            && !files.contains(&path)
        {
            files.push(path);
        }
    }
    files
}

/// The libdevice that came with a libNVVM.
pub fn libdevice(library: &Path) -> Option<PathBuf> {
    // <toolkit>/nvvm/lib64/libnvvm.so and <wheel>/lib/libnvvm.so.4
    let places = library.ancestors().skip(1).take(3);
    places
        .flat_map(|dir| [dir.join("libdevice"), dir.join("nvvm/libdevice")])
        .map(|dir| dir.join("libdevice.10.bc"))
        .find(|file| file.is_file())
}

/// The files `path` in the packages that `cargo optix setup --nvvm` has installed into the folder `cache`, those of the
/// newest CUDA last.
pub fn cached(cache: &Path, path: &str) -> Vec<PathBuf> {
    let roots = cached_packages(cache).into_iter().flat_map(|packages| roots(&packages));
    roots.map(|root| root.join(path)).filter(|path| path.exists()).collect()
}

/// The folders of packages in the cache, one for each package and version.
fn cached_packages(cache: &Path) -> Vec<PathBuf> {
    list(cache, "nvidia-nvvm")
}

/// The folders of Python packages that stand for a CUDA toolkit: `nvidia/cu13`, and `nvidia/cuda_nvcc` before CUDA 13.
fn roots(packages: &Path) -> Vec<PathBuf> {
    list(&packages.join("nvidia"), "cu")
}

fn folders(cache: Option<&Path>) -> Vec<PathBuf> {
    let mut folders = Vec::new();
    let wheels = |folders: &mut Vec<PathBuf>, packages: &Path| {
        folders.extend(roots(packages).iter().flat_map(|root| [root.join("lib"), root.join("nvvm/lib64")]));
    };
    cache.into_iter().flat_map(cached_packages).for_each(|packages| wheels(&mut folders, &packages));
    for name in ["CUDA_HOME", "CUDA_PATH", "CUDA_ROOT"] {
        folders.extend(std::env::var_os(name).map(|root| PathBuf::from(root).join("nvvm/lib64")));
    }
    folders.extend(list(Path::new("/usr/local"), "cuda").into_iter().map(|root| root.join("nvvm/lib64")));
    folders.push("/opt/cuda/nvvm/lib64".into());
    // The driver brings its own libNVVM, under a different name.
    folders.extend(["/usr/lib/x86_64-linux-gnu", "/usr/lib64", "/usr/lib/aarch64-linux-gnu"].map(PathBuf::from));
    folders.extend(std::env::var_os("LD_LIBRARY_PATH").iter().flat_map(std::env::split_paths));
    python_packages().iter().for_each(|packages| wheels(&mut folders, packages));
    folders
}

/// The folders in which the Python in use has its packages.
fn python_packages() -> Vec<PathBuf> {
    let script = "import site; print('\\n'.join(site.getsitepackages() + [site.getusersitepackages()]))";
    let output = Command::new("python3").args(["-c", script]).output();
    let text = output.map(|output| String::from_utf8_lossy(&output.stdout).into_owned()).unwrap_or_default();
    text.lines().map(PathBuf::from).collect()
}

/// The entries of a folder whose names start with `prefix`, in order.
fn list(dir: &Path, prefix: &str) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(dir).map(|entries| entries.flatten().collect()).unwrap_or_else(|_| Vec::new());
    let matching = entries.iter().filter(|entry| entry.file_name().to_string_lossy().starts_with(prefix));
    let mut paths: Vec<PathBuf> = matching.map(|entry| entry.path()).collect();
    paths.sort();
    paths
}
