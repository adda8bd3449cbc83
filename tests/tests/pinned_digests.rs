//! The digests of short runs, pinned: the same on every machine, processor and build.
//!
//! CI runs this twice: as built for the processors of today, and built for any x86-64 and on an emulated one of 2008 that has neither
//! AVX nor fused multiply-add:
//!
//! ```console
//! $ export RUSTFLAGS="" CARGO_TARGET_DIR=target/no-fma
//! $ export CARGO_TARGET_X86_64_UNKNOWN_LINUX_GNU_RUNNER="qemu-x86_64 -cpu Nehalem"
//! $ cargo test --release -p shoal-tests --test pinned_digests
//! ```
//!
//! A change that gives runs another digest on purpose pins the new ones: `INSTA_UPDATE=always cargo test ...`.

use shoal_tests::{library_scenario, run_local};

/// Digest and checks of the first `duration_s` seconds of a scenario of the library.
fn digest(name: &str, duration_s: i64) -> String {
    let mut scenario = library_scenario(name);
    scenario.duration_ns = duration_s * 1_000_000_000;
    let summary = run_local(&scenario, None);
    format!("{} after {} checks", summary.digest, summary.containment.checks)
}

macro_rules! pinned {
    ($($test:ident: $name:literal for $duration_s:literal s),* $(,)?) => {
        $(
            #[test]
            fn $test() {
                insta::assert_snapshot!($name, digest($name, $duration_s));
            }
        )*
    };
}

pinned! {
    two_circles: "two-circles" for 6 s,
    six_circles: "six-circles" for 60 s,
    a_swarm: "swarm-300" for 2 s,
    a_thermocline: "thermocline" for 5 s,
    echoes: "echoes" for 10 s,
    a_kidnapping: "kidnapped" for 20 s,
}
