//! Proof that both ends know the same token, which itself never crosses the network.

use std::fmt::Write;

/// What makes keys of tokens differ from whatever else is made of them.
const CONTEXT: &str = "shoal 2026-11-23 token of hosts";

/// Who proves that it knows the token.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Prover {
    Host,
    Launcher,
}

/// The proof for these two nonces, one drawn by each end: BLAKE3, keyed by the token.
pub(super) fn proof(token: &str, prover: Prover, host_nonce: &str, launcher_nonce: &str) -> String {
    let key = blake3::derive_key(CONTEXT, token.as_bytes());
    let who = match prover {
        Prover::Host => "host",
        Prover::Launcher => "launcher",
    };
    let mut hasher = blake3::Hasher::new_keyed(&key);
    for part in [who, host_nonce, launcher_nonce] {
        hasher.update(&(part.len() as u64).to_le_bytes());
        hasher.update(part.as_bytes());
    }
    hasher.finalize().to_hex().to_string()
}

/// Whether `stated` is that proof. Takes as long for a wrong one as for the right one.
pub(super) fn is_proof(
    stated: &str,
    token: &str,
    prover: Prover,
    host_nonce: &str,
    launcher_nonce: &str,
) -> bool {
    let expected = blake3::Hash::from_hex(proof(token, prover, host_nonce, launcher_nonce));
    let stated = blake3::Hash::from_hex(stated);
    // The comparison of hashes is in constant time.
    matches!((expected, stated), (Ok(expected), Ok(stated)) if expected == stated)
}

/// `bytes` random bytes, as hexadecimal digits.
pub(super) fn random_hex(bytes: usize) -> std::io::Result<String> {
    use std::io::Read;

    let mut drawn = vec![0; bytes];
    std::fs::File::open("/dev/urandom")?.read_exact(&mut drawn)?;
    Ok(drawn.iter().fold(String::new(), |mut text, byte| {
        // Writing to a string does not fail.
        let _infallible = write!(text, "{byte:02x}");
        text
    }))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_the_same_token_and_nonces_prove_anything() {
        let proof = proof("open sesame", Prover::Host, "ab", "c");
        assert!(is_proof(&proof, "open sesame", Prover::Host, "ab", "c"));
        assert!(!is_proof(&proof, "open barley", Prover::Host, "ab", "c"));
        assert!(!is_proof(&proof, "open sesame", Prover::Launcher, "ab", "c"));
        assert!(!is_proof(&proof, "open sesame", Prover::Host, "a", "bc"));
        assert!(!is_proof("", "open sesame", Prover::Host, "ab", "c"));
        assert_eq!(random_hex(8).unwrap().len(), 16);
        assert_ne!(random_hex(8).unwrap(), random_hex(8).unwrap());
    }
}
