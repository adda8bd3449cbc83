//! Who is in range of whom, as a graph: its edges, its components, its Laplacian.

use crate::body::Vec3;
use crate::grid::Grid;

/// With more links than so many the graph is not kept: a swarm where everybody hears everybody needs no figure that says so.
const LINKS_MAX: usize = 4_000_000;

/// AUVs as vertices of a graph. Two are linked when each is within the range of the other's modem.
pub struct Links {
    /// Ordered pairs of which the second is within the range of the first.
    reached: u64,
    /// Number of vertices of each component, in no order that means anything.
    components: Vec<u32>,
    graph: Option<Graph>,
}

/// The links of each vertex, one after the other.
#[derive(Debug)]
pub struct Graph {
    /// Where the links of each vertex begin in `others`, and where the last one's end.
    starts: Vec<u32>,
    others: Vec<u32>,
}

impl Links {
    /// The graph of AUVs at `places_m` whose modems reach as far as `range_m`, one of each for every AUV. Time and memory are in
    /// proportion to the number of AUVs and of links.
    pub fn between(places_m: &[Vec3], range_m: &[f64]) -> Self {
        let mut grid = Grid::default();
        grid.sort(places_m, range_m.iter().fold(0.0, |a: f64, &b| a.max(b)));
        let mut forest = Forest::new(places_m.len());
        let (mut starts, mut others) = (vec![0], Vec::new());
        let (mut reached, mut is_kept) = (0, true);
        for (vertex, (&place_m, &reach_m)) in places_m.iter().zip(range_m).enumerate() {
            let begin = others.len();
            for (other, other_m) in grid.near(place_m, reach_m) {
                let distance_m = (place_m - other_m).norm();
                if other == vertex || distance_m > reach_m {
                    continue;
                }
                reached += 1;
                if distance_m <= range_m[other] {
                    forest.join(vertex as u32, other as u32);
                    others.push(other as u32);
                }
            }
            is_kept &= others.len() <= LINKS_MAX;
            if is_kept {
                // The order of a sum decides its last bit.
                others[begin..].sort_unstable();
            } else {
                others.clear();
            }
            starts.push(others.len() as u32);
        }
        Self { reached, components: forest.components(), graph: is_kept.then_some(Graph { starts, others }) }
    }

    /// Fraction of all ordered pairs whose second can hear the first; zero of fewer than two AUVs.
    pub fn fraction(&self) -> f64 {
        let count: u64 = self.components.iter().map(|&vertices| u64::from(vertices)).sum();
        if count < 2 { 0.0 } else { self.reached as f64 / (count * (count - 1)) as f64 }
    }

    /// Number of connected components of the graph.
    pub fn components(&self) -> u32 {
        self.components.len() as u32
    }

    /// Number of AUVs in its largest component.
    pub fn largest_component(&self) -> u32 {
        self.components.iter().copied().max().unwrap_or(0)
    }

    /// The graph; `None` with more than four million links.
    pub fn graph(&self) -> Option<&Graph> {
        self.graph.as_ref()
    }
}

impl Graph {
    /// Number of vertices.
    pub fn vertices(&self) -> usize {
        self.starts.len() - 1
    }

    /// Greatest number of links of a vertex.
    pub fn degree_max(&self) -> u32 {
        self.starts.windows(2).map(|ends| ends[1] - ends[0]).max().unwrap_or(0)
    }

    /// Writes the Laplacian (degrees less adjacency) times `values` into `product`, both of one number per vertex.
    pub fn laplacian(&self, values: &[f64], product: &mut [f64]) {
        for ((ends, &value), product) in self.starts.windows(2).zip(values).zip(product) {
            let others = &self.others[ends[0] as usize..ends[1] as usize];
            *product = others.iter().map(|&other| value - values[other as usize]).sum();
        }
    }
}

/// Vertices that belong together (union-find with path halving, Tarjan and van Leeuwen 1984).
struct Forest {
    parents: Vec<u32>,
    sizes: Vec<u32>,
}

impl Forest {
    fn new(vertices: usize) -> Self {
        Self { parents: (0..vertices as u32).collect(), sizes: vec![1; vertices] }
    }

    fn root(&mut self, mut vertex: u32) -> u32 {
        while self.parents[vertex as usize] != vertex {
            let above = self.parents[self.parents[vertex as usize] as usize];
            self.parents[vertex as usize] = above;
            vertex = above;
        }
        vertex
    }

    fn join(&mut self, a: u32, b: u32) {
        let (mut large, mut small) = (self.root(a), self.root(b));
        if large == small {
            return;
        }
        if self.sizes[large as usize] < self.sizes[small as usize] {
            std::mem::swap(&mut large, &mut small);
        }
        self.parents[small as usize] = large;
        self.sizes[large as usize] += self.sizes[small as usize];
    }

    /// Number of vertices of each tree.
    fn components(&self) -> Vec<u32> {
        let is_root = |&vertex: &usize| self.parents[vertex] as usize == vertex;
        (0..self.parents.len()).filter(is_root).map(|root| self.sizes[root]).collect()
    }
}
