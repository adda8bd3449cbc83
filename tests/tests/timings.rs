//! `--timings` and `shoal bench`: where the time goes.

use shoal_tests::Command;

#[test]
fn timings_add_up_and_change_nothing() {
    for bus in ["local", "iceoryx2"] {
        let run = || Command::new("run six-circles --duration 10 --bus").with(bus);
        let plain = run().json();
        assert_eq!(plain["timings"], serde_json::Value::Null);
        let timed = run().and("--timings").json();
        assert_eq!(timed["digest"], plain["digest"]);
        let timings = &timed["timings"];
        let windows = timings["windows"].as_u64().unwrap();
        assert!(windows > 50, "{timings}");
        let phases = timings["phases"].as_array().unwrap();
        let names: Vec<&str> = phases.iter().map(|phase| phase["phase"].as_str().unwrap()).collect();
        assert_eq!(names, ["channel", "wake", "record", "agents", "gather", "accept"]);
        let of = |phase: &serde_json::Value, key: &str| phase[key].as_f64().unwrap();
        assert!((phases.iter().map(|phase| of(phase, "share")).sum::<f64>() - 1.0).abs() < 1e-9);
        for phase in phases {
            assert!(
                of(phase, "median_ms") <= of(phase, "p95_ms") && of(phase, "p95_ms") <= of(phase, "max_ms")
            );
        }
        // The phases are all of the run but the loop around them.
        let (total_s, wall_s) = (of(timings, "total_ms") * 1e-3, timed["wall_s"].as_f64().unwrap());
        assert!(total_s <= wall_s && total_s > 0.5 * wall_s, "{total_s} s of {wall_s} s");
        let stretches = timings["over_time"].as_array().unwrap();
        assert!((10..=20).contains(&stretches.len()));
        let cpu = &timings["cpu"];
        let (all, own) = (of(cpu, "us_per_auv_s"), of(cpu, "channel_us_per_auv_s"));
        assert!(own > 0.0 && if bus == "local" { all == own } else { all > own }, "{cpu}");
        assert!(of(cpu, "switches_per_wake") > 0.0 || bus == "local", "{cpu}");
    }
}

#[test]
fn a_graph_is_printed_behind_the_summary() {
    let text = Command::new("run six-circles --duration 10 --bus local --timings --quiet")
        .finish()
        .succeeded()
        .stdout;
    let (summary, graph) = text.split_once("where the time of ").expect("there is a graph");
    assert!(summary.contains("digest") && graph.contains("windows went"), "{text}");
    for phase in ["# channel", "w wake", "r record", ". agents", "g gather", "a accept"] {
        assert!(graph.contains(phase), "{phase}: {graph}");
    }
    assert!(graph.contains("us per AUV and simulated second"), "{graph}");
}

#[test]
fn scale_is_measured_beside_a_hundred() {
    let line = "bench scale --auvs 10,100,20 --bus local --duration-s 1 --json";
    let lines = Command::new(line).finish().succeeded().json_lines();
    let names: Vec<&str> = lines.iter().map(|line| line["name"].as_str().unwrap()).collect();
    assert_eq!(names, ["scale/local/10", "scale/local/100", "scale/local/20"]);
    assert!(
        lines.iter().all(|line| line["format"] == "shoal.bench/1" && line["value"].as_f64().unwrap() > 0.0)
    );
    assert!(lines[0]["beside"].is_null());
    assert_eq!(lines[1]["beside"]["ratio"], 1.0);
    assert!(lines[2]["beside"]["ratio"].as_f64().unwrap() > 0.0);
    let line = "bench tap --scenario swarm-300 --duration-s 3 --pairs 1 --json";
    let figures = Command::new(line).finish().succeeded().json();
    assert_eq!((&figures["format"], &figures["name"]), (&"shoal.bench/1".into(), &"tap/swarm-300".into()));
    assert!(
        figures["beside"]["ratio"].as_f64().unwrap() > 0.0 && figures["lines"].as_u64().unwrap() > 0,
        "{figures}"
    );
    let table = Command::new("bench scale --auvs 10 --duration-s 1").finish().succeeded().stdout;
    assert_eq!(table.lines().count(), 2, "{table}");
}
