//! What a scenario says about the water and about what an AUV is made of: defaults, every form of every key, every preset.

use shoal_scenario::presets::{BOTTOMS, CLOCKS, DVLS, GNSS, KINDS, SENSORS};
use shoal_scenario::{
    Absorption, CurrentField, Dvl, Fading, FadingKind, FadingPer, Level, NamedProfile, Scenario, Sea,
    SoundSpeed, SoundSpeedFormula, parse,
};

/// A scenario with these lines in `[environment]`, and these in its one group.
fn scenario(environment: &str, group: &str) -> Scenario {
    let text = format!(
        "name = \"a\"\nduration_s = 1\n[environment]\narea_m = [[0, 100], [0, 100], [-80, 0]]\n{environment}\n\
         [[group]]\nname = \"a\"\ncount = 1\n{group}\n"
    );
    parse("a.toml", &text).unwrap_or_else(|errors| panic!("{errors}"))
}

fn sea(lines: &str) -> Sea {
    let scenario = scenario(&format!("level = \"sea\"\n{lines}"), "modem = \"micromodem-psk\"");
    match scenario.environment.level {
        Level::Sea(sea) => sea,
        Level::Ideal => panic!("not a sea"),
    }
}

#[test]
fn a_sea_of_which_nothing_is_said() {
    let sand = BOTTOMS.iter().find(|(name, _)| *name == "sand").unwrap().1;
    let expected = Sea {
        sound_speed: SoundSpeed::Uniform,
        bottom_depth_m: 80.0,
        temperature_c: 10.0,
        salinity_psu: 35.0,
        ph: 8.0,
        absorption: Absorption::FrancoisGarrison,
        spreading_exponent: 1.5,
        shipping: 0.5,
        wind_m_s: 5.0,
        surface_loss_db: None,
        bottom: sand,
        bounces_max: 2,
        fading: Fading { kind: FadingKind::Rician { k_db: 6.0 }, per: FadingPer::Packet },
    };
    assert_eq!(sea(""), expected);
    assert_eq!(sea("[environment.sea]"), expected);
    assert_eq!((expected.bottom.density_kg_m3, expected.bottom.sound_speed_m_s), (1900.0, 1650.0));
}

#[test]
fn a_sea_of_which_all_is_said() {
    let sea = sea(r#"
        [environment.sea]
        bottom_depth_m = 80
        temperature_c = -1.5
        salinity_psu = 33
        ph = 7.9
        absorption = "thorp-jkps"
        spreading_exponent = 2
        shipping = 0
        wind_m_s = 0
        surface_loss_db = 0
        bottom = { density_kg_m3 = 1150, sound_speed_m_s = 1480, attenuation_db_wavelength = 0.1 }
        bounces_max = 8
        fading = { kind = "rician", k_db = -3, per = "bit" }
        [environment.sea.sound_speed]
        depths_m = [0.5, 12, 80, 4000]
        temperatures_c = [-1.5, 0, 45, -3]
        salinities_psu = [45, 30, 30, 33]
        formula = "del-grosso"
    "#);
    assert_eq!(sea.bottom_depth_m, 80.0);
    assert_eq!((sea.temperature_c, sea.salinity_psu, sea.ph), (-1.5, 33.0, 7.9));
    assert_eq!(sea.absorption, Absorption::ThorpJkps);
    assert_eq!((sea.spreading_exponent, sea.shipping, sea.wind_m_s), (2.0, 0.0, 0.0));
    assert_eq!((sea.surface_loss_db, sea.bottom.density_kg_m3, sea.bounces_max), (Some(0.0), 1150.0, 8));
    assert_eq!(sea.fading, Fading { kind: FadingKind::Rician { k_db: -3.0 }, per: FadingPer::Bit });
    let expected = SoundSpeed::Water {
        depths_m: vec![0.5, 12.0, 80.0, 4000.0],
        temperatures_c: vec![-1.5, 0.0, 45.0, -3.0],
        salinities_psu: vec![45.0, 30.0, 30.0, 33.0],
        formula: SoundSpeedFormula::DelGrosso,
    };
    assert_eq!(sea.sound_speed, expected);
}

#[test]
fn every_name_means_what_it_says() {
    let profile = |name: &str| sea(&format!("sea.sound_speed = \"{name}\"")).sound_speed;
    assert_eq!(profile("uniform"), SoundSpeed::Uniform);
    assert_eq!(profile("mixed-layer"), SoundSpeed::Named(NamedProfile::MixedLayer));
    assert_eq!(profile("summer-thermocline"), SoundSpeed::Named(NamedProfile::SummerThermocline));
    assert_eq!(profile("arctic"), SoundSpeed::Named(NamedProfile::Arctic));
    assert_eq!(profile("munk"), SoundSpeed::Named(NamedProfile::Munk));
    let absorption = |name: &str| sea(&format!("sea.absorption = \"{name}\"")).absorption;
    assert_eq!(absorption("francois-garrison"), Absorption::FrancoisGarrison);
    assert_eq!(absorption("ainslie-mccolm"), Absorption::AinslieMcColm);
    assert_eq!(absorption("thorp-stojanovic"), Absorption::ThorpStojanovic);
    let fading = |text: &str| sea(&format!("sea.fading = {text}")).fading.kind;
    assert_eq!(fading("\"gaussian\""), FadingKind::Gaussian);
    assert_eq!(fading("\"rayleigh\""), FadingKind::Rayleigh);
    assert_eq!(fading("{ kind = \"rician\" }"), FadingKind::Rician { k_db: 6.0 });
    let speeds = sea("sea.sound_speed = { depths_m = [0, 0.001], speeds_m_s = [1300, 1800] }").sound_speed;
    assert_eq!(speeds, SoundSpeed::Speeds { depths_m: vec![0.0, 0.001], speeds_m_s: vec![1300.0, 1800.0] });
    let water = "sea.sound_speed = { depths_m = [0, 9], temperatures_c = [9, 8], salinities_psu = [0, 0]";
    let formula = |rest: &str| match sea(&format!("{water}{rest} }}")).sound_speed {
        SoundSpeed::Water { formula, .. } => formula,
        _ => panic!("not water"),
    };
    assert_eq!(formula(""), SoundSpeedFormula::ChenMillero);
    assert_eq!(formula(", formula = \"mackenzie\""), SoundSpeedFormula::Mackenzie);
    assert_eq!(formula(", formula = \"medwin\""), SoundSpeedFormula::Medwin);
}

#[test]
fn currents_differ_from_place_to_place() {
    let field = |text: &str| scenario(&format!("current_field = {text}"), "").environment.current_field;
    assert_eq!(scenario("", "").environment.current_field, CurrentField::Uniform);
    assert_eq!(field("\"uniform\""), CurrentField::Uniform);
    let shear =
        field("{ name = \"shear\", surface_m_s = [0.5, 0, 0], deep_m_s = [0, -0.1, 0], depth_m = 30 }");
    let expected =
        CurrentField::Shear { surface_m_s: [0.5, 0.0, 0.0], deep_m_s: [0.0, -0.1, 0.0], depth_m: 30.0 };
    assert_eq!(shear, expected);
    let vortex = field("{ name = \"vortex\", centre_m = [50, -500], core_radius_m = 20, speed_m_s = -0.4 }");
    assert_eq!(
        vortex,
        CurrentField::Vortex { centre_m: [50.0, -500.0], core_radius_m: 20.0, speed_m_s: -0.4 }
    );
}

#[test]
fn a_field_of_current_counts_in_the_speed_of_a_body() {
    let refused = |field: &str, sound_m_s: f64| {
        let text = format!(
            "name = \"a\"\nduration_s = 1\n[environment]\narea_m = [[0, 9], [0, 9], [-9, 0]]\ncurrent_m_s = [-2, 0, 0]\n\
             sound_speed_m_s = {sound_m_s}\ncurrent_field = {field}\n[[group]]\nname = \"a\"\ncount = 1\n\
             kind = {{ like = \"lauv\", disturbance_m_s = [0, 0, 0] }}\n"
        );
        parse("a.toml", &text).is_err()
    };
    // 2.5 m/s through the water, and a current of -2 + 6 at one end, of -2 - 1 at the other: 6.5 m/s, twice.
    let shear = "{ name = \"shear\", surface_m_s = [6, 0, 0], deep_m_s = [-1, 0, 0], depth_m = 5 }";
    assert!(refused(shear, 12.9) && !refused(shear, 13.0));
    let upside_down = "{ name = \"shear\", surface_m_s = [-1, 0, 0], deep_m_s = [6, 0, 0], depth_m = 5 }";
    assert!(refused(upside_down, 12.9) && !refused(upside_down, 13.0));
    let vortex = "{ name = \"vortex\", centre_m = [0, 0], core_radius_m = 1, speed_m_s = -3 }";
    assert!(refused(vortex, 14.9) && !refused(vortex, 15.0));
}

#[test]
fn every_preset_can_be_named_and_is_like_itself() {
    for (name, kind) in KINDS {
        assert_eq!(&scenario("", &format!("kind = \"{name}\"")).groups[0].kind, kind);
        assert_eq!(&scenario("", &format!("kind = {{ like = \"{name}\" }}")).groups[0].kind, kind);
    }
    for (name, clock) in CLOCKS {
        assert_eq!(&scenario("", &format!("clock = {{ like = \"{name}\" }}")).groups[0].clock, clock);
    }
    for (name, sensors) in SENSORS {
        assert_eq!(&scenario("", &format!("sensors = \"{name}\"")).groups[0].sensors, sensors);
        assert_eq!(&scenario("", &format!("[group.sensors]\nlike = \"{name}\"")).groups[0].sensors, sensors);
    }
    for (name, dvl) in DVLS {
        assert_eq!(
            scenario("", &format!("sensors.dvl = \"{name}\"")).groups[0].sensors.dvl.as_ref(),
            Some(dvl)
        );
    }
    for (name, gnss) in GNSS {
        assert_eq!(
            scenario("", &format!("sensors.gnss = \"{name}\"")).groups[0].sensors.gnss.as_ref(),
            Some(gnss)
        );
    }
    for (name, bottom) in BOTTOMS {
        assert_eq!(&sea(&format!("sea.bottom = \"{name}\"")).bottom, bottom);
    }
}

#[test]
fn sensors_change_what_they_are_like() {
    let own = |lines: &str| scenario("", lines).groups[0].sensors.clone();
    let nominal = own("");
    assert_eq!((nominal.heading_error_rad, nominal.pitch_error_rad), (0.01, 0.01));
    assert_eq!((nominal.speed_error_m_s, nominal.depth_error_m), (0.02, Some(0.1)));
    assert_eq!((nominal.dvl, nominal.gnss), (None, None));
    let suite = SENSORS.iter().find(|(name, _)| *name == "ahrs-dvl").unwrap().1.clone();
    let changed = own(
        "sensors = { like = \"ahrs-dvl\", depth_error_m = false, dvl.altitude_max_m = 30, gnss.period_s = 5 }",
    );
    assert_eq!((changed.heading_error_rad, changed.depth_error_m), (suite.heading_error_rad, None));
    let velocity_error_m_s = suite.dvl.as_ref().unwrap().velocity_error_m_s;
    assert_eq!(changed.dvl, Some(Dvl { altitude_max_m: 30.0, velocity_error_m_s }));
    let (own_gnss, gnss) = (changed.gnss.unwrap(), suite.gnss.unwrap());
    assert_eq!((own_gnss.period_ns, own_gnss.depth_max_m), (5_000_000_000, gnss.depth_max_m));
    let without = own("sensors = { like = \"ahrs-dvl\", dvl = false, gnss = false }");
    assert_eq!((without.dvl, without.gnss), (None, None));
    let named = "sensors = \"mine\"\n[sensors.mine]\nlike = \"yours\"\n[sensors.yours]\nlike = \"fog-ins\"\nheading_error_rad = 0";
    assert_eq!(own(named).heading_error_rad, 0.0);
    assert!(own(named).dvl.is_some());
}
