//! Links the executable to a fixed address.
//!
//! Linked to any address, each process of a run rewrites half a megabyte of pointers when it starts: pages of its own, where it could
//! share those of all others, and a third of the time that it takes to start.

fn main() {
    println!("cargo:rerun-if-changed=build.rs");
    let target = |name: &str| std::env::var(format!("CARGO_CFG_TARGET_{name}")).unwrap_or_default();
    if target("OS") == "linux" && target("ENV") == "gnu" {
        println!("cargo:rustc-link-arg-bins=-no-pie");
    }
}
