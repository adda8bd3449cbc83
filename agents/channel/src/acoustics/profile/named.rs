//! Profiles with names, for scenarios that have no measured one.

use pxfm::{f_exp, f_log};

use super::{Node, Profile};

/// What pressure alone adds to the speed of sound in water of one temperature and salinity, in 1/s (Urick, *Principles of
/// Underwater Sound*, 3rd edition, section 5.2: 0.016 to 0.017).
const PRESSURE_1_S: f64 = 0.016;

/// Deep enough for every table: the deepest sea has 11 km.
const DEEPEST_M: f64 = 12_000.0;

impl Profile {
    /// Water that wind has mixed to 60 m: a surface duct above a thermocline.
    ///
    /// 1500 m/s at the surface, the gradient of pressure alone (+0.016 1/s, Urick, section 5.2) in the mixed layer, -0.1 1/s
    /// through a thermocline of 100 m, which is about -3 degrees, then a weakening permanent one (-0.02 1/s to 400 m, -0.005 1/s to 900 m) and pressure alone
    /// again.
    pub fn mixed_layer(bottom_m: f64) -> Self {
        let gradients_1_s =
            [(60.0, PRESSURE_1_S), (160.0, -0.1), (400.0, -0.02), (900.0, -0.005), (DEEPEST_M, PRESSURE_1_S)];
        let mut nodes = vec![Node { depth_m: 0.0, speed_m_s: 1500.0 }];
        let (mut top_m, mut speed_m_s) = (0.0, 1500.0);
        for (depth_m, gradient_1_s) in gradients_1_s {
            speed_m_s += gradient_1_s * (depth_m - top_m);
            top_m = depth_m;
            nodes.push(Node { depth_m, speed_m_s });
        }
        down_to(bottom_m, nodes)
    }

    /// The Mediterranean in late summer: 15 m of warm water, a thermocline down to 100 m that bends every ray downwards, and
    /// the slow rise that pressure makes below.
    ///
    /// Speeds by Chen-Millero (1977) with the coefficients of Wong and Zhu (1995) at 40 degrees north, from temperatures and salinities in the
    /// range that Salon et al. (*Annales Geophysicae* 21, 2003, 833-846) report: 25 degrees and 38.2 at the surface,
    /// 21 at 25 m, 17 at 40 m, 15 at 60 m, 14 and 38.3 at 100 m, 13.6 and 38.5 at 200 m, 13.2 at 1000 m, 13.3 at 2000 m.
    pub fn summer_thermocline(bottom_m: f64) -> Self {
        down_to(
            bottom_m,
            table(&[
                (0.0, 1537.9),
                (15.0, 1538.1),
                (25.0, 1528.2),
                (40.0, 1517.2),
                (60.0, 1511.4),
                (100.0, 1509.0),
                (200.0, 1509.7),
                (1000.0, 1521.7),
                (2000.0, 1538.9),
            ]),
        )
    }

    /// The central Arctic under ice: coldest and freshest at the surface, so that every ray bends upwards.
    ///
    /// Speeds by Chen-Millero (1977) with the coefficients of Wong and Zhu (1995) at 85 degrees north, extrapolated below 0 degrees. The three water
    /// masses are those of casts near 86 degrees north (US Geological Survey Arctic cruise of 2011, station 4: -1.6 degrees and 30.95 at the surface,
    /// about 1 degree near 300 m, -0.3 degrees and 34.95 at depth); taken here: -1.7 degrees and 31.5 to 25 m, -1.6 and 32.2 at
    /// 50 m, -1.5 and 33.3 at 100 m, -0.6 and 34.5 at 200 m, 0.5 and 34.8 at 300 m, 0.4 and 34.87 at 500 m, -0.2 and 34.88 at 1000 m,
    /// -0.7 and 34.93 at 2000 m, -0.6 and 34.95 at 4000 m.
    pub fn arctic(bottom_m: f64) -> Self {
        down_to(
            bottom_m,
            table(&[
                (0.0, 1436.4),
                (25.0, 1436.8),
                (50.0, 1438.7),
                (100.0, 1441.5),
                (200.0, 1449.0),
                (300.0, 1456.1),
                (500.0, 1459.1),
                (1000.0, 1464.7),
                (2000.0, 1479.5),
                (4000.0, 1515.1),
            ]),
        )
    }

    /// The canonical profile of the deep sound channel: `1500 (1 + 0.00737 (eta - 1 + exp(-eta)))` m/s with
    /// `eta = 2 (depth - 1300 m) / 1300 m`.
    ///
    /// The form is that of Munk (*Journal of the Acoustical Society of America* 55, 1974, 220-226), the numbers are those of Jensen et al.,
    /// *Computational Ocean Acoustics*, section 5. Nodes lie so that the linear interpolation errs alike in every layer:
    /// nowhere by more than 0.16 m/s.
    pub fn munk(bottom_m: f64) -> Self {
        const AXIS_M: f64 = 1300.0;
        let speed_m_s = |depth_m: f64| {
            let eta = 2.0 * (depth_m - AXIS_M) / AXIS_M;
            1500.0 * (1.0 + 0.00737 * (eta - 1.0 + f_exp(-eta)))
        };
        // A chord over a step h errs by h² c''/8, and c'' goes as exp(-eta): the error is the same in every layer when
        // equal steps are taken in exp(-eta / 2), 0.15 m/s for steps of 0.165.
        let spread = |depth_m: f64| f_exp(-(depth_m - AXIS_M) / AXIS_M);
        let deepest_m = if bottom_m > 0.0 { bottom_m.min(DEEPEST_M) } else { DEEPEST_M };
        let (start, end) = (spread(0.0), spread(deepest_m));
        let layers = ((start - end) / 0.165).ceil().max(1.0);
        let depth_m = |index: f64| AXIS_M * (1.0 - f_log(start + (end - start) * index / layers));
        let inner = (1..layers as usize).map(|index| depth_m(index as f64));
        let depths_m = [0.0].into_iter().chain(inner).chain([deepest_m]);
        let nodes = depths_m.map(|depth_m| Node { depth_m, speed_m_s: speed_m_s(depth_m) }).collect();
        down_to(bottom_m, nodes)
    }
}

fn table(rows: &[(f64, f64)]) -> Vec<Node> {
    rows.iter().map(|&(depth_m, speed_m_s)| Node { depth_m, speed_m_s }).collect()
}

/// Cuts a table off at the bottom, or goes on from it to the bottom as pressure alone has it.
fn down_to(bottom_m: f64, mut nodes: Vec<Node>) -> Profile {
    if let Some(&last) = nodes.last()
        && bottom_m > last.depth_m + super::LEAST_SPACING_M
    {
        let depth_m = bottom_m.min(DEEPEST_M.max(last.depth_m + 1.0));
        nodes.push(Node { depth_m, speed_m_s: last.speed_m_s + PRESSURE_1_S * (depth_m - last.depth_m) });
    }
    let whole = Profile::through(nodes);
    let kept = |node: &&Node| node.depth_m < bottom_m - super::LEAST_SPACING_M;
    let mut nodes: Vec<Node> = whole.nodes.iter().filter(kept).copied().collect();
    if nodes.is_empty() {
        nodes.push(whole.nodes[0]);
    } else if nodes.len() < whole.nodes.len() {
        nodes.push(Node { depth_m: bottom_m, speed_m_s: whole.speed_m_s(bottom_m) });
    }
    Profile::through(nodes)
}
