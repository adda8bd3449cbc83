//! A Gaussian over the state of an AUV, and how motion and measurements change it.

use nalgebra::{SMatrix, SVector};

/// Position (3), true minus local time, its rate, current (3): in metres, seconds, seconds per second, m/s.
pub const STATES: usize = 8;
/// Index of the first coordinate of the position, in metres.
pub const POSITION: usize = 0;
/// Index of true minus local time, in seconds.
pub const OFFSET: usize = 3;
/// Index of the gain of true minus local time, per local second.
pub const RATE: usize = 4;
/// Index of the first coordinate of the current, in m/s.
pub const CURRENT: usize = 5;

/// A state, or the row of a linear measurement of it.
pub type Vector = SVector<f64, STATES>;
/// A covariance of states, or a linear map of them.
pub type Matrix = SMatrix<f64, STATES, STATES>;

/// What a Kalman filter believes.
#[derive(Clone, Debug, PartialEq)]
pub struct Filter {
    /// Mean of the state.
    pub mean: Vector,
    /// Covariance of the state: symmetric.
    pub covariance: Matrix,
}

/// One number measured: linear in the state near its mean.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measurement {
    /// Derivative of the number by the state.
    pub row: Vector,
    /// What was measured less what the mean lets expect.
    pub innovation: f64,
    /// Variance of the measurement's own error.
    pub variance: f64,
}

impl Filter {
    /// Goes on to `mean`, where `transition` takes a deviation from the mean and `noise` is the covariance of what is added.
    pub fn predict(&mut self, mean: Vector, transition: &Matrix, noise: &Matrix) {
        self.mean = mean;
        self.covariance = symmetric(&(transition * self.covariance * transition.transpose() + noise));
    }

    /// The variance of the number that a measurement with this row sees.
    pub fn variance_along(&self, row: &Vector) -> f64 {
        row.dot(&(self.covariance * row))
    }

    /// Takes in a measurement whose error has nothing to do with the state's; false, and nothing done, when its variance is no
    /// variance. In the form of Joseph, `(I - K H) P (I - K H)' + K R K'`, which leaves a covariance whatever is
    /// rounded (Bucy and Joseph, Filtering for Stochastic Processes with Applications to Guidance, 1968).
    pub fn update(&mut self, measured: &Measurement) -> bool {
        let spread = self.covariance * measured.row;
        let variance = measured.row.dot(&spread) + measured.variance;
        let sound = variance > 0.0 && variance.is_finite() && measured.innovation.is_finite();
        if !sound || measured.variance < 0.0 {
            return false;
        }
        let gain = spread / variance;
        let kept = Matrix::identity() - gain * measured.row.transpose();
        let own = gain * gain.transpose() * measured.variance;
        self.mean += gain * measured.innovation;
        self.covariance = symmetric(&(kept * self.covariance * kept.transpose() + own));
        true
    }

    /// Never knows less of a coordinate than it was told, a variance that holds at any time: what has become more uncertain is
    /// scaled down to it, all correlations kept.
    pub fn limit(&mut self, index: usize, variance: f64) {
        let own = self.covariance[(index, index)];
        if own > variance {
            let scale = (variance / own).sqrt();
            self.covariance.row_mut(index).scale_mut(scale);
            self.covariance.column_mut(index).scale_mut(scale);
        }
    }
}

fn symmetric(of: &Matrix) -> Matrix {
    (of + of.transpose()) * 0.5
}
