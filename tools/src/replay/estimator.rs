//! Another estimator, named as scenarios name it.

use shoal_bus::message::Estimator;
use shoal_channel::channel::Channel;

use crate::failure::Failure;

/// The estimator that a scenario with `estimator = KIND` gives its AUVs; a bare name needs no quotation marks.
pub fn named(kind: &str) -> Result<Estimator, Failure> {
    let is_name = kind.chars().all(|letter| letter.is_ascii_alphanumeric() || "-_".contains(letter));
    let value = if is_name { format!("\"{kind}\"") } else { kind.to_owned() };
    let text = format!(
        "name = \"estimator\"\nduration_s = 1\nenvironment.area_m = [[0, 100], [0, 100], [-10, 0]]\n\
         [[group]]\nname = \"all\"\ncount = 1\nestimator = {value}\n"
    );
    let scenario = shoal_scenario::parse("--estimator", &text).map_err(|errors| Failure::usage(format!(
        "--estimator {kind}: give `tube`, `ekf`, `dead-reckoning`, or a table as in a scenario, such as `{{ name = \"tube\", rings = 0 }}`:\n\
         {errors}"
    )))?;
    let channel = Channel::new(&scenario).map_err(Failure::failed)?;
    let born = channel.born().into_iter().next();
    born.map(|born| born.orders.estimator).ok_or_else(|| Failure::failed("a scenario of one AUV has none"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn estimators_are_named_as_in_scenarios() {
        assert!(matches!(named("ekf").unwrap(), Estimator::Ekf(_)));
        assert!(matches!(named("dead-reckoning").unwrap(), Estimator::DeadReckoning));
        let Estimator::Tube(settings) = named(r#"{ name = "tube", rings = 0 }"#).unwrap() else { panic!() };
        assert_eq!(settings.rings, 0);
        for wrong in ["kalman", "{ name = ", "\"ekf\"\ncount = 2", r#"{ name = "tube", ring = 0 }"#] {
            let failure = named(wrong).unwrap_err();
            assert!(failure.message.contains("give `tube`, `ekf`, `dead-reckoning`"), "{}", failure.message);
        }
    }
}
