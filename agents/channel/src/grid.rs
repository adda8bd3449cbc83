//! Who is near: places sorted into cells, so that a ping asks its neighbourhood and not the whole swarm.

use crate::body::Vec3;

/// More cells than so many per place would cost more than they save.
const CELLS_PER_PLACE: usize = 4;

/// Places of one moment in cubic cells over their bounding box, numbered by the order in which they were given.
///
/// Building costs time and memory in proportion to the number of places, wherever they are; a query costs what lies in the
/// cells that it touches.
#[derive(Debug, Default)]
pub struct Grid {
    least_m: Vec3,
    cell_m: f64,
    cells: [usize; 3],
    /// Where each cell's members begin in `members`, and where the last one's end.
    starts: Vec<u32>,
    members: Vec<u32>,
    /// Their places, in the same order.
    members_m: Vec<Vec3>,
    cell_of: Vec<u32>,
    next: Vec<u32>,
}

impl Grid {
    /// Sorts places into cells with sides of at least `cell_m` metres, larger where the places are few and far between.
    pub fn sort(&mut self, places_m: &[Vec3], cell_m: f64) {
        let (mut least, mut greatest) = (Vec3::repeat(f64::INFINITY), Vec3::repeat(f64::NEG_INFINITY));
        for place in places_m {
            least = least.inf(place);
            greatest = greatest.sup(place);
        }
        if places_m.is_empty() {
            (least, greatest) = (Vec3::zeros(), Vec3::zeros());
        }
        let extent = greatest - least;
        let cells_max = CELLS_PER_PLACE * places_m.len() + 64;
        let mut cell_m = cell_m.max(1e-3);
        let count = |cell_m: f64| [0, 1, 2].map(|axis| (extent[axis] / cell_m).floor() + 1.0);
        while count(cell_m).iter().product::<f64>() > cells_max as f64 {
            cell_m *= 1.5;
        }
        self.least_m = least;
        self.cell_m = cell_m;
        self.cells = count(cell_m).map(|cells| cells as usize);
        self.fill(places_m);
    }

    /// The cell of a place: of two neighbours in this order, the places are near each other.
    pub fn cell_of(&self, place: usize) -> u32 {
        self.cell_of[place]
    }

    /// All places within `radius_m` of `centre_m`, and none that is farther by more than rounding, with their numbers, in no order
    /// that means anything.
    pub fn near(&self, centre_m: Vec3, radius_m: f64) -> impl Iterator<Item = (usize, Vec3)> {
        let range = |axis: usize| {
            let cell = |coordinate: f64| (coordinate - self.least_m[axis]) / self.cell_m;
            let last = self.cells[axis] as f64 - 1.0;
            let from = cell(centre_m[axis] - radius_m).floor();
            let to = cell(centre_m[axis] + radius_m).floor();
            // Nothing lies outside of the cells, so a range that does not meet them is empty.
            if to < 0.0 || from > last {
                return 0..0;
            }
            from.max(0.0) as usize..to.min(last) as usize + 1
        };
        let (xs, ys, zs) = (range(0), range(1), range(2));
        let [_, rows, layers] = self.cells;
        let radius_m2 = radius_m * radius_m * (1.0 + 1e-12);
        xs.flat_map(move |x| {
            let zs = zs.clone();
            ys.clone().flat_map(move |y| {
                let row = (x * rows + y) * layers;
                let (from, to) = (row + zs.start, row + zs.end);
                if zs.is_empty() { 0..0 } else { self.starts[from] as usize..self.starts[to] as usize }
            })
        })
        .map(|at| (self.members[at] as usize, self.members_m[at]))
        .filter(move |(_, place_m)| (place_m - centre_m).norm_squared() <= radius_m2)
    }

    /// Counting sort: cells along z are neighbours in memory, so that a query reads whole rows.
    fn fill(&mut self, places_m: &[Vec3]) {
        let [columns, rows, layers] = self.cells;
        self.cell_of.clear();
        self.cell_of.extend(places_m.iter().map(|place| {
            let at = |axis: usize| {
                let cell = ((place[axis] - self.least_m[axis]) / self.cell_m).floor() as usize;
                cell.min(self.cells[axis] - 1)
            };
            ((at(0) * rows + at(1)) * layers + at(2)) as u32
        }));
        self.starts.clear();
        self.starts.resize(columns * rows * layers + 1, 0);
        for &cell in &self.cell_of {
            self.starts[cell as usize + 1] += 1;
        }
        for cell in 1..self.starts.len() {
            self.starts[cell] += self.starts[cell - 1];
        }
        self.members.clear();
        self.members.resize(places_m.len(), 0);
        self.members_m.clear();
        self.members_m.resize(places_m.len(), Vec3::zeros());
        self.next.clone_from(&self.starts);
        for (place, &cell) in self.cell_of.iter().enumerate() {
            let at = &mut self.next[cell as usize];
            self.members[*at as usize] = place as u32;
            self.members_m[*at as usize] = places_m[place];
            *at += 1;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn draws(count: usize, extent_m: Vec3, seed: u64) -> Vec<Vec3> {
        let mut state = seed;
        let mut unit = move || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1u64 << 53) as f64
        };
        (0..count).map(|_| extent_m.map(|side| side * (unit() - 0.5))).collect()
    }

    #[test]
    fn nobody_near_is_missed_and_few_others_are_asked() {
        let extents = [Vec3::new(1e3, 1e3, 1e3), Vec3::new(1e5, 10.0, 1.0), Vec3::new(0.0, 0.0, 0.0)];
        for (seed, extent_m) in extents.into_iter().enumerate() {
            let places_m = draws(2_000, extent_m, seed as u64 + 1);
            let mut grid = Grid::default();
            grid.sort(&places_m, 100.0);
            for (index, &centre_m) in places_m.iter().enumerate().step_by(37) {
                let centre_m = centre_m + Vec3::new(index as f64 * 0.1, -3.0, 7.0);
                let found: std::collections::BTreeSet<usize> =
                    grid.near(centre_m, 100.0).map(|(number, _)| number).collect();
                for (number, place) in places_m.iter().enumerate() {
                    let near = (place - centre_m).norm() <= 100.0;
                    assert!(!near || found.contains(&number), "{number} is missing");
                }
            }
        }
        let places_m = draws(2_000, extents[0], 1);
        let mut grid = Grid::default();
        grid.sort(&places_m, 100.0);
        let asked = grid.near(Vec3::zeros(), 100.0).count();
        assert!((1..20).contains(&asked), "{asked} of 2,000 asked for a sphere that holds about 8");
    }

    #[test]
    fn nothing_and_far_away_are_fine() {
        let mut grid = Grid::default();
        grid.sort(&[], 10.0);
        assert_eq!(grid.near(Vec3::zeros(), 1e9).count(), 0);
        grid.sort(&[Vec3::repeat(1e7), Vec3::repeat(-1e7)], 1e-9);
        assert_eq!(grid.near(Vec3::zeros(), 1.0).count(), 0);
        assert_eq!(grid.near(Vec3::zeros(), 1e9).count(), 2);
    }
}
