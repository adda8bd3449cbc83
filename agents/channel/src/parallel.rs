//! The work of a window in pieces of the swarm, side by side on all cores with the feature `parallel`, else one after the other.
//!
//! What a piece does depends on its own vehicles and on what nobody changes meanwhile, and leaves its outcome in its own share;
//! shares are taken together in the order of the swarm. So neither the number of cores nor who is first can change a result.

/// So many AUVs, or pings, are one piece of work: enough to be worth waking another core for.
pub(crate) const PIECE: usize = 32;

/// Lets `work` do each piece of `a`, with its part of `b`, which is as long, and its share. There are [`shares_of`] shares.
pub(crate) fn share_out<A: Send, B: Send, S: Send>(
    a: &mut [A],
    b: &mut [B],
    shares: &mut [S],
    work: impl Fn(&mut [A], &mut [B], &mut S) + Sync,
) {
    debug_assert_eq!((a.len(), shares_of(a.len())), (b.len(), shares.len()));
    #[cfg(feature = "parallel")]
    if shares.len() > 1 {
        use rayon::prelude::*;

        let pieces = a.par_chunks_mut(PIECE).zip(b.par_chunks_mut(PIECE)).zip(shares);
        return pieces.for_each(|((a, b), share)| work(a, b, share));
    }
    let pieces = a.chunks_mut(PIECE).zip(b.chunks_mut(PIECE)).zip(shares);
    pieces.for_each(|((a, b), share)| work(a, b, share));
}

/// In how many pieces so many come.
pub(crate) fn shares_of(count: usize) -> usize {
    count.div_ceil(PIECE)
}

/// Sorts; equal elements may change places.
pub(crate) fn sort<T: Ord + Send>(of: &mut [T]) {
    #[cfg(feature = "parallel")]
    if of.len() >= WORTH_SORTING_TOGETHER {
        use rayon::prelude::*;

        return of.par_sort_unstable();
    }
    of.sort_unstable();
}

#[cfg(feature = "parallel")]
const WORTH_SORTING_TOGETHER: usize = 4_096;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_element_is_worked_on_once_with_its_own_partner_and_share() {
        for count in [0, 1, PIECE - 1, PIECE, PIECE + 1, 10 * PIECE + 7] {
            let mut a: Vec<usize> = (0..count).collect();
            let mut b = vec![0; count];
            let mut shares = vec![Vec::new(); shares_of(count)];
            share_out(&mut a, &mut b, &mut shares, |a, b, share: &mut Vec<usize>| {
                for (a, b) in a.iter().zip(b) {
                    *b += 2 * a;
                    share.push(*a);
                }
            });
            assert_eq!(b, (0..count).map(|a| 2 * a).collect::<Vec<_>>());
            assert_eq!(shares.concat(), a);
        }
    }
}
