//! Whether this processor can run what was built: a sentence instead of an illegal instruction.

use crate::failure::Failure;

/// Refuses a processor that lacks instructions which `.cargo/config.toml` lets the compiler use.
#[cfg(all(target_arch = "x86_64", target_feature = "avx2", target_feature = "fma"))]
#[inline(never)]
pub fn check() -> Result<(), Failure> {
    use std::arch::x86_64::__cpuid_count;

    const FMA_AND_AVX: u32 = (1 << 12) | (1 << 28);
    const AVX2_AND_BMI: u32 = (1 << 5) | (1 << 3) | (1 << 8);
    let knows_leaf_7 = __cpuid_count(0, 0).eax >= 7;
    if knows_leaf_7
        && __cpuid_count(1, 0).ecx & FMA_AND_AVX == FMA_AND_AVX
        && __cpuid_count(7, 0).ebx & AVX2_AND_BMI == AVX2_AND_BMI
    {
        return Ok(());
    }
    Err(Failure::failed(
        "this processor has no AVX2 or FMA instructions, for which shoal was built; build it anew with \
         `RUSTFLAGS=\"\" cargo build --release`: results are the same, only slower",
    ))
}

/// Nothing that this processor could lack was asked for.
#[cfg(not(all(target_arch = "x86_64", target_feature = "avx2", target_feature = "fma")))]
pub fn check() -> Result<(), Failure> {
    Ok(())
}
