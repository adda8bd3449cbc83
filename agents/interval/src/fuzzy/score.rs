//! Score functions: what it is worth to be in some granules and not in others.

use super::{FuzzyError, Grade};

/// A closure is asked about every combination of this many granules at most.
const MOST_TABULATED: usize = 16;

/// A score function under construction: granules, and weighted means, least and greatest values of parts.
///
/// Whatever is built like this is monotone, 0 in no granule and 1 in all, so that no check of that is needed.
///
/// ```
/// use shoal_interval::fuzzy::{Grade, Score, ScoreFunction};
///
/// // In the room for sure, and the more of two ranges the better: seed 000, equation (5.18) without the pillar.
/// let ranges = Score::mean([(1, Score::granule(1)), (1, Score::granule(2))]);
/// let score = ScoreFunction::new(3, Score::least([Score::granule(0), ranges]))?;
/// assert_eq!(score.of(|granule| granule != 2), Grade::new(1, 2)?);
/// assert_eq!(score.of(|granule| granule != 0), Grade::ZERO);
/// # Ok::<(), shoal_interval::fuzzy::FuzzyError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Score {
    kind: Kind,
}

#[derive(Debug, Clone, PartialEq)]
enum Kind {
    Granule(usize),
    Mean(Vec<(u32, Score)>),
    Least(Vec<Score>),
    Greatest(Vec<Score>),
}

impl Score {
    /// One in this granule, zero elsewhere. Granules are counted from zero.
    pub fn granule(granule: usize) -> Score {
        Score { kind: Kind::Granule(granule) }
    }

    /// The weighted mean of parts.
    pub fn mean(parts: impl IntoIterator<Item = (u32, Score)>) -> Score {
        Score { kind: Kind::Mean(parts.into_iter().collect()) }
    }

    /// The smallest of parts: what must hold for all of them.
    pub fn least(parts: impl IntoIterator<Item = Score>) -> Score {
        Score { kind: Kind::Least(parts.into_iter().collect()) }
    }

    /// The largest of parts: what is enough for one of them.
    pub fn greatest(parts: impl IntoIterator<Item = Score>) -> Score {
        Score { kind: Kind::Greatest(parts.into_iter().collect()) }
    }
}

/// A score function: a map from the granules that a vector is in to a [`Grade`] that is 0 for none, 1 for all, and never
/// falls when a granule is added.
///
/// Source: seed 000, equation (2.47).
#[derive(Debug, Clone, PartialEq)]
pub struct ScoreFunction {
    granules: usize,
    values: Values,
}

#[derive(Debug, Clone, PartialEq)]
enum Values {
    Tree(Node),
    /// The value of each combination; bit `j` of its number says whether granule `j` is in it.
    Table(Vec<Grade>),
}

/// A part of a tree whose every value is a whole number divided by `denominator`.
#[derive(Debug, Clone, PartialEq)]
struct Node {
    denominator: u32,
    kind: NodeKind,
}

#[derive(Debug, Clone, PartialEq)]
enum NodeKind {
    Granule(usize),
    /// Parts, each with what its value is multiplied by on the common denominator.
    Mean(Vec<(u32, Node)>),
    Least(Vec<(u32, Node)>),
    Greatest(Vec<(u32, Node)>),
}

impl ScoreFunction {
    /// The weighted mean of all granules, one weight for each.
    ///
    /// # Errors
    /// [`FuzzyError`] when no weight is positive, or when their sum is too large.
    ///
    /// Source: seed 000, equation (2.50).
    pub fn weighted_mean(weights: &[u32]) -> Result<ScoreFunction, FuzzyError> {
        let parts = weights.iter().enumerate().map(|(granule, &weight)| (weight, Score::granule(granule)));
        ScoreFunction::new(weights.len(), Score::mean(parts))
    }

    /// The score function of so many granules that was built from [`Score`]s.
    ///
    /// # Errors
    /// [`FuzzyError`] when a granule does not exist, a part is empty or the weights are too fine.
    pub fn new(granules: usize, score: Score) -> Result<ScoreFunction, FuzzyError> {
        Ok(ScoreFunction { granules, values: Values::Tree(node(granules, score)?) })
    }

    /// The score function that a closure computes. It is asked about every combination, and checked.
    ///
    /// # Errors
    /// [`FuzzyError`] when there are more than 16 granules, or when the closure is not a score function.
    pub fn from_fn(granules: usize, score: impl Fn(&[bool]) -> Grade) -> Result<ScoreFunction, FuzzyError> {
        if granules > MOST_TABULATED {
            return Err(FuzzyError::TooManyGranules { granules, limit: MOST_TABULATED });
        }
        let combinations = 1_usize << granules;
        let table: Vec<Grade> = (0..combinations)
            .map(|combination| {
                let members: Vec<bool> =
                    (0..granules).map(|granule| combination >> granule & 1 == 1).collect();
                score(&members)
            })
            .collect();
        let (none, all) = (table[0], table[combinations - 1]);
        if none != Grade::ZERO || all != Grade::ONE {
            return Err(FuzzyError::Ends { none, all });
        }
        for (combination, &without) in table.iter().enumerate() {
            for granule in 0..granules {
                let with = table[combination | 1 << granule];
                if with < without {
                    return Err(FuzzyError::NotMonotone { granule, without, with });
                }
            }
        }
        Ok(ScoreFunction { granules, values: Values::Table(table) })
    }

    /// How many granules it has.
    pub fn granules(&self) -> usize {
        self.granules
    }

    /// The score of a vector that is in the granules for which `members` says so.
    pub fn of(&self, members: impl Fn(usize) -> bool) -> Grade {
        match &self.values {
            Values::Tree(node) => Grade::from_parts(node.numerator(&members), node.denominator),
            Values::Table(table) => {
                table[(0..self.granules)
                    .fold(0, |bits, granule| bits | usize::from(members(granule)) << granule)]
            }
        }
    }
}

impl Node {
    fn numerator(&self, members: &impl Fn(usize) -> bool) -> u32 {
        // No sum exceeds the denominator, which fits: `node` has made sure.
        let scaled = |(factor, part): &(u32, Node)| factor * part.numerator(members);
        match &self.kind {
            NodeKind::Granule(granule) => u32::from(members(*granule)),
            NodeKind::Mean(parts) => parts.iter().map(scaled).sum(),
            NodeKind::Least(parts) => parts.iter().map(scaled).min().unwrap_or(0),
            NodeKind::Greatest(parts) => parts.iter().map(scaled).max().unwrap_or(0),
        }
    }
}

fn node(granules: usize, score: Score) -> Result<Node, FuzzyError> {
    match score.kind {
        Kind::Granule(granule) if granule >= granules => Err(FuzzyError::NoSuchGranule { granule, granules }),
        Kind::Granule(granule) => Ok(Node { denominator: 1, kind: NodeKind::Granule(granule) }),
        Kind::Mean(parts) => {
            let (denominator, parts) = on_common_denominator(granules, parts)?;
            let total = parts.iter().try_fold(0_u32, |sum, (weight, ..)| sum.checked_add(*weight));
            let total = total.ok_or(FuzzyError::TooFine)?;
            if total == 0 {
                return Err(FuzzyError::NoWeight);
            }
            let parts = parts.into_iter().map(|(weight, factor, part)| (weight * factor, part));
            let denominator = denominator.checked_mul(total).ok_or(FuzzyError::TooFine)?;
            Ok(Node { denominator, kind: NodeKind::Mean(parts.collect()) })
        }
        Kind::Least(parts) => extreme(granules, parts, NodeKind::Least),
        Kind::Greatest(parts) => extreme(granules, parts, NodeKind::Greatest),
    }
}

fn extreme(
    granules: usize,
    parts: Vec<Score>,
    kind: impl Fn(Vec<(u32, Node)>) -> NodeKind,
) -> Result<Node, FuzzyError> {
    if parts.is_empty() {
        return Err(FuzzyError::NoWeight);
    }
    let parts = parts.into_iter().map(|part| (1, part)).collect();
    let (denominator, parts) = on_common_denominator(granules, parts)?;
    let parts = parts.into_iter().map(|(_, factor, part)| (factor, part));
    Ok(Node { denominator, kind: kind(parts.collect()) })
}

type Scaled = (u32, u32, Node);

/// The parts with their weights and with what takes each to the smallest common denominator.
fn on_common_denominator(
    granules: usize,
    parts: Vec<(u32, Score)>,
) -> Result<(u32, Vec<Scaled>), FuzzyError> {
    let mut nodes = Vec::with_capacity(parts.len());
    let mut common = 1_u32;
    for (weight, part) in parts {
        let part = node(granules, part)?;
        let step = part.denominator / greatest_common_divisor(common, part.denominator);
        common = common.checked_mul(step).ok_or(FuzzyError::TooFine)?;
        nodes.push((weight, part));
    }
    let scaled = nodes.into_iter().map(|(weight, part)| (weight, common / part.denominator, part));
    Ok((common, scaled.collect()))
}

fn greatest_common_divisor(mut a: u32, mut b: u32) -> u32 {
    while b > 0 {
        (a, b) = (b, a % b);
    }
    a
}
