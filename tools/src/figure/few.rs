//! A figure with fewer points that shows the same: no extreme is lost.

use super::{Entry, Figure, Layer};

impl Figure {
    /// The same figure with about `most` points a line and bound, and as many marks a layer.
    ///
    /// Of points side by side on a line the first, the last, the least and the greatest are kept, each where it was, so that no
    /// peak goes missing at any zoom; of marks and segments every n-th, which the legend then says.
    #[must_use]
    pub fn with_at_most(mut self, most: usize) -> Self {
        let mut every = 1;
        for layer in self.panels.iter_mut().flat_map(|panel| &mut panel.layers) {
            match layer {
                Layer::Line { points, .. } => *points = extremes(points, most),
                Layer::Area { corners, .. } => {
                    let half = corners.len() / 2;
                    let bounds = [&corners[..half], &corners[half..]];
                    *corners = bounds.iter().flat_map(|bound| extremes(bound, most)).collect();
                }
                Layer::Marks { points, .. } => {
                    every = every.max(thin(points, most));
                }
                Layer::Segments { ends, .. } => every = every.max(thin(ends, most)),
                Layer::Bars { .. } | Layer::Boxes { .. } | Layer::Arcs { .. } => {}
            }
        }
        if every > 1 {
            self.legend.push(Entry::remark(format!("up to {most} marks and links of a kind shown")));
        }
        self
    }
}

/// Keeps every n-th, and says n.
fn thin<T: Copy>(all: &mut Vec<T>, most: usize) -> usize {
    let every = all.len().div_ceil(most.max(1)).max(1);
    *all = all.iter().copied().step_by(every).collect();
    every
}

/// The first, last, least and greatest of points side by side, in their order, so that about `most` are left; all when there are no more.
fn extremes(points: &[[f64; 2]], most: usize) -> Vec<[f64; 2]> {
    if points.len() <= most {
        return points.to_vec();
    }
    let side_by_side = (4 * points.len()).div_ceil(most.max(1)).max(1);
    let mut kept = Vec::with_capacity(most + 4);
    for chunk in points.chunks(side_by_side) {
        let by_value = |a: &usize, b: &usize| chunk[*a][1].total_cmp(&chunk[*b][1]);
        let finite = || (0..chunk.len()).filter(|index| chunk[*index][1].is_finite());
        let mut indices =
            [Some(0), finite().min_by(by_value), finite().max_by(by_value), Some(chunk.len() - 1)];
        indices.sort_unstable();
        let mut last = None;
        for index in indices.into_iter().flatten().filter(|index| last.replace(*index) != Some(*index)) {
            kept.push(chunk[index]);
        }
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_with_fewer_points_keeps_every_extreme() {
        let value = |index: usize| match index {
            777 => 5.0,
            5_003 => -7.0,
            index => (index % 3) as f64,
        };
        let points: Vec<[f64; 2]> = (0..10_000).map(|index| [index as f64, value(index)]).collect();
        let few = extremes(&points, 500);
        assert!((250..=504).contains(&few.len()), "{}", few.len());
        assert!(few.contains(&[777.0, 5.0]) && few.contains(&[5_003.0, -7.0]));
        assert!(few.windows(2).all(|pair| pair[0][0] < pair[1][0]));
        assert_eq!((few[0], few[few.len() - 1]), (points[0], points[9_999]));
        assert_eq!(extremes(&points, 10_000), points);
    }

    #[test]
    fn what_is_not_finite_is_no_extreme() {
        let points: Vec<[f64; 2]> =
            (0..100).map(|index| [index as f64, if index == 50 { f64::NAN } else { 1.0 }]).collect();
        let few = extremes(&points, 4);
        assert_eq!(few, [[0.0, 1.0], [99.0, 1.0]]);
    }
}
