//! Algebraic connectivity: how hard it is to cut a graph in two.
//!
//! It is the second smallest eigenvalue of the graph's Laplacian (Fiedler, "Algebraic connectivity of graphs", Czechoslovak
//! Mathematical Journal 23, 1973): zero when the graph has several components, small when few links hold it together, and as large as the
//! number of vertices when all are linked.

use super::links::{Graph, Links};

/// No more steps than so many: the cost at ten thousand AUVs with twenty neighbours each stays at some tenth of a second.
const STEPS_MAX: usize = 600;

/// The eigenvalue of the small matrix is looked at every so many steps.
const LOOK_EVERY: usize = 16;

/// The eigenvalue is good when its residual is this part of it.
const TOLERANCE: f64 = 1e-6;

/// The algebraic connectivity of a graph; zero of one with several components or fewer than two vertices; `None` when the links were too
/// many to be kept.
///
/// By Lanczos' method (Golub and Van Loan, "Matrix Computations", 4th ed., section 10.1) on all vectors whose sum is zero, from a start
/// that is always the same. It needs no old vectors: where rounding loses orthogonality, eigenvalues that were found come a second time,
/// and the least of them stays the least. The result approaches the eigenvalue from above, to a millionth of it for all graphs but
/// those that are both large and hardly held together, such as a chain of a thousand.
pub fn algebraic_connectivity(links: &Links) -> Option<f64> {
    let graph = links.graph()?;
    Some(if links.components() == 1 && graph.vertices() > 1 { second_eigenvalue(graph) } else { 0.0 })
}

fn second_eigenvalue(graph: &Graph) -> f64 {
    let vertices = graph.vertices();
    // No eigenvalue of a Laplacian exceeds twice the greatest degree.
    let scale = 2.0 * f64::from(graph.degree_max());
    let mut last = vec![0.0; vertices];
    let mut now = start(vertices);
    let mut next = vec![0.0; vertices];
    let mut matrix = Tridiagonal::default();
    let mut beside = 0.0;
    for step in 1..=STEPS_MAX {
        graph.laplacian(&now, &mut next);
        let diagonal = dot(&now, &next);
        for ((next, now), last) in next.iter_mut().zip(&now).zip(&last) {
            *next -= diagonal * now + beside * last;
        }
        // Rounding brings back what belongs to the eigenvalue zero.
        centre(&mut next);
        matrix.push(diagonal, beside);
        beside = dot(&next, &next).sqrt();
        let is_complete = beside <= 1e-12 * scale;
        if is_complete || step % LOOK_EVERY == 0 || step == STEPS_MAX {
            let (value, tail) = matrix.least();
            if is_complete || beside * tail <= TOLERANCE * value {
                return value;
            }
        }
        std::mem::swap(&mut last, &mut now);
        for (now, next) in now.iter_mut().zip(&next) {
            *now = next / beside;
        }
    }
    matrix.least().0
}

/// A vector of length one whose numbers have no pattern (SplitMix64) and the sum zero.
fn start(vertices: usize) -> Vec<f64> {
    let mut state = 0_u64;
    let mut draw = || {
        state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut bits = state;
        bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        (bits >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    };
    let mut values: Vec<f64> = (0..vertices).map(|_| draw()).collect();
    centre(&mut values);
    let length = dot(&values, &values).sqrt();
    values.iter_mut().for_each(|value| *value /= length);
    values
}

fn centre(values: &mut [f64]) {
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    values.iter_mut().for_each(|value| *value -= mean);
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// A symmetric matrix with nothing but its diagonal and the numbers beside it.
#[derive(Default)]
struct Tridiagonal {
    diagonal: Vec<f64>,
    /// Squares of the numbers beside the diagonal, each with the row in which it comes first; the first is zero.
    beside_squared: Vec<f64>,
}

impl Tridiagonal {
    fn push(&mut self, diagonal: f64, beside: f64) {
        self.diagonal.push(diagonal);
        self.beside_squared.push(beside * beside);
    }

    /// The least eigenvalue of a positive definite matrix, by bisection, and the size of the last component of its eigenvector of
    /// length one.
    fn least(&self) -> (f64, f64) {
        let (mut lower, mut upper) = (0.0, self.diagonal.iter().copied().fold(f64::INFINITY, f64::min));
        loop {
            let middle = 0.5 * (lower + upper);
            if middle <= lower || middle >= upper {
                return (upper, self.tail(lower));
            }
            if self.is_below_all(middle) { lower = middle } else { upper = middle }
        }
    }

    /// The ratios of successive leading principal minors of the matrix less `value` times the identity, with their derivatives by
    /// `value`, until one is not positive.
    fn ratios(&self, value: f64) -> impl Iterator<Item = (f64, f64)> {
        let rows = self.diagonal.iter().zip(&self.beside_squared);
        rows.scan((1.0, 0.0), move |(ratio, slope), (diagonal, beside_squared)| {
            if *ratio <= 0.0 {
                return None;
            }
            *slope = -1.0 + beside_squared * *slope / (*ratio * *ratio);
            *ratio = diagonal - value - beside_squared / *ratio;
            Some((*ratio, *slope))
        })
    }

    /// Whether all eigenvalues are greater than `value` (Sturm's theorem).
    fn is_below_all(&self, value: f64) -> bool {
        self.ratios(value).all(|(ratio, _)| ratio > 0.0)
    }

    /// The size of the last component of the eigenvector of `value`, the least eigenvalue: the last ratio falls through zero there
    /// with a slope of one over its square.
    fn tail(&self, value: f64) -> f64 {
        let slope = self.ratios(value).map(|(_, slope)| slope).last().unwrap_or(-1.0);
        if slope.is_finite() { (1.0 / slope.abs()).sqrt() } else { 0.0 }
    }
}
