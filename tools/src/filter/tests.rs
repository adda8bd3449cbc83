//! What filters mean, what is refused and how, and that nothing panics.

use proptest::prelude::*;
use serde_json::{Value, json};
use shoal_bus::record::Topic;

use super::*;

fn matches(filter: &str, message: &Value) -> bool {
    Filter::parse(filter).unwrap_or_else(|error| panic!("{error}")).matches(message)
}

fn refused(filter: &str) -> String {
    Filter::parse(filter).and_then(|filter| filter.check(&Fields::of(Topic::Pings))).unwrap_err().to_string()
}

#[test]
fn filters_mean_what_they_say() {
    let ping = json!({
        "fate": "lost", "t_ns": 2_500_000_000_i64, "from": 7, "to": null, "range_m": 412.5, "outlier": true,
        "reason": "collision", "colliding": [3, 9], "position_m": [1.0, -2.0, -50.0],
        "reception": {"sinr_db": -3.5, "path": "surface-bottom"}, "around": [{"auv": 4}, {"auv": 5}], "box_width_m": null,
    });
    for yes in [
        "range_m > 400",
        "range_m>400&&range_m<=412.5",
        "fate == lost",
        "fate = 'lost'",
        "from != 8 and from in (1, 7)",
        "reason in (late, collision)",
        "outlier",
        "not to",
        "!to",
        "to == null",
        "colliding == 9",
        "not colliding == 4",
        "colliding != 4",
        "position_m.2 <= -5e1",
        "position_m.2 < -4.9e+1",
        "reception.sinr_db < 0 and reception.path ~ bottom",
        "around.auv == 5",
        "around.1.auv == 5 and not around.0.auv == 5",
        "t_s == 2.5",
        "fate == heard or from == 7",
        "not (fate == heard or from == 8)",
        // `and` binds closer than `or`, `not` closer than both.
        "fate == lost or fate == heard and from == 8",
        "not fate == heard and from == 7",
        "missing != 3 or outlier == true",
    ] {
        assert!(matches(yes, &ping), "{yes}");
        assert!(!matches(&format!("not ({yes})"), &ping), "not ({yes})");
    }
    for no in [
        "missing == 3",
        "missing != 3",
        "missing",
        "to",
        "fate > 3",
        "range_m ~ '4'",
        "box_width_m > 0",
        "around.7.auv == 4",
    ] {
        assert!(!matches(no, &ping), "{no}");
    }
}

#[test]
fn what_is_wrong_is_shown_with_its_place_and_a_fix() {
    insta::assert_snapshot!(
        [
            "range_m > and from == 7",
            "rang_m > 400",
            "range > 400",
            "reception.sinr < 3",
            "from == 7 to == 3",
            "(from == 7",
            "from == 7)",
            "",
            "name == \"green",
            "range_m > 400m",
            "range_m > far",
            "reason in late",
            "from & to",
            "größe > 3 # 4",
            "7 == from",
        ]
        .map(refused)
        .join("\n\n")
    );
}

#[test]
fn depth_and_length_are_bounded() {
    for deep in ["(".repeat(10_000), "not ".repeat(10_000), "a or ".repeat(10_000)] {
        assert!(Filter::parse(&deep).is_err());
    }
    assert!(Filter::parse(&format!("a{}", " and a".repeat(200))).is_ok());
}

fn literal() -> impl Strategy<Value = Literal> {
    prop_oneof![
        any::<f64>().prop_filter("finite", |number| number.is_finite()).prop_map(Literal::Number),
        ".*".prop_map(Literal::Text),
        any::<bool>().prop_map(Literal::Bool),
        Just(Literal::Null),
    ]
}

fn path() -> impl Strategy<Value = Path> {
    "[a-d](\\.[a-d0-2]){0,2}".prop_map(|name| Path { name, span: 0..0 })
}

fn expression() -> impl Strategy<Value = Expression> {
    let number = any::<f64>().prop_filter("finite", |number| number.is_finite()).prop_map(Literal::Number);
    let ordered = proptest::sample::select(vec![Comparison::Less, Comparison::GreaterOrEqual]);
    let equal = proptest::sample::select(vec![Comparison::Equal, Comparison::NotEqual]);
    let leaf = prop_oneof![
        path().prop_map(Expression::Has),
        (path(), ordered, number).prop_map(|(path, how, number)| Expression::Compare(path, how, number)),
        (path(), equal, literal()).prop_map(|(path, how, literal)| Expression::Compare(path, how, literal)),
        (path(), proptest::collection::vec(literal(), 1..4))
            .prop_map(|(path, listed)| Expression::In(path, listed)),
    ];
    leaf.prop_recursive(4, 16, 2, |inner| {
        let two = (inner.clone(), inner.clone());
        prop_oneof![
            two.clone().prop_map(|(one, other)| Expression::Or(Box::new(one), Box::new(other))),
            two.prop_map(|(one, other)| Expression::And(Box::new(one), Box::new(other))),
            inner.prop_map(|inner| Expression::Not(Box::new(inner))),
        ]
    })
}

fn message() -> impl Strategy<Value = Value> {
    let leaf = prop_oneof![
        Just(Value::Null),
        any::<bool>().prop_map(Value::from),
        (-3_i32..3).prop_map(Value::from),
        "[a-c]".prop_map(Value::from),
    ];
    leaf.prop_recursive(3, 16, 3, |inner| {
        prop_oneof![
            proptest::collection::vec(inner.clone(), 0..3).prop_map(Value::from),
            proptest::collection::btree_map("[a-d]", inner, 0..4).prop_map(|map| map.into_iter().collect()),
        ]
    })
}

proptest! {
    #[test]
    fn what_is_written_is_understood_as_the_same(expression in expression()) {
        let text = expression.to_string();
        let parsed = Filter::parse(&text).map_err(|error| TestCaseError::fail(error.to_string()))?;
        prop_assert_eq!(parsed.expression, expression);
    }

    #[test]
    fn any_text_is_understood_or_refused_within_itself(text in "([a-z0-9_.<>=!&|()~\"' ,é-]|and |or |not |in ){0,24}|.*") {
        if let Err(error) = Filter::parse(&text) {
            let span = error.span();
            prop_assert!(span.start <= span.end && text.get(span.clone()).is_some(), "{:?}", span);
            prop_assert!(error.to_string().contains("= help: "));
        }
    }

    #[test]
    fn de_morgan_holds(one in expression(), other in expression(), message in message()) {
        let not_and = Expression::Not(Box::new(Expression::And(Box::new(one.clone()), Box::new(other.clone()))));
        let or_not = Expression::Or(Box::new(Expression::Not(Box::new(one))), Box::new(Expression::Not(Box::new(other))));
        prop_assert_eq!(not_and.matches(&message), or_not.matches(&message));
    }

    #[test]
    fn a_field_that_is_found_is_itself(message in message(), path in path()) {
        let found = find(&message, &path.name);
        if let Some(Value::String(text)) = &found {
            let equal = Expression::Compare(path.clone(), Comparison::Equal, Literal::Text(text.clone()));
            prop_assert!(equal.matches(&message));
        }
        let has = Expression::Has(path).matches(&message);
        prop_assert!(!has || !matches!(found, Some(Value::Null | Value::Bool(_))) || found == Some(Value::Bool(true)));
    }
}
