//! Whatever is in a file, it is answered with a scenario or with errors, never with a panic.

use shoal_scenario::{Overrides, library, parse};

/// SplitMix64: enough to choose what to break.
struct Draws(u64);

impl Draws {
    fn below(&mut self, bound: usize) -> usize {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) % bound.max(1) as u64) as usize
    }
}

/// All that a file may say about the water and sensors: the library says little of it.
const SEA: &str = r#"
name = "sea"
duration_s = 10
[environment]
area_m = [[0, 1000], [0, 1000], [-100, 0]]
level = "sea"
current_field = { name = "shear", surface_m_s = [0.4, 0, 0], deep_m_s = [0, 0, 0], depth_m = 50 }
[environment.sea]
bottom_depth_m = 120
temperature_c = 12
absorption = "ainslie-mccolm"
spreading_exponent = 1.5
shipping = 0.5
wind_m_s = 5
surface_loss_db = 1
bottom = { density_kg_m3 = 1900, sound_speed_m_s = 1650, attenuation_db_wavelength = 0.8 }
bounces_max = 3
fading = { kind = "rician", k_db = 6, per = "bit" }
[environment.sea.sound_speed]
depths_m = [0, 20, 60]
temperatures_c = [22, 21, 13]
salinities_psu = [38, 38, 38.3]
formula = "mackenzie"
[sensors.mine]
like = "ahrs-dvl"
dvl = { altitude_max_m = 50, velocity_error_m_s = 0.01 }
gnss = "standalone"
[[group]]
name = "a"
count = 3
modem = "micromodem-psk"
sensors = "mine"
"#;

const PIECES: &[&str] = &[
    "",
    "0",
    "-1",
    "1e999",
    "-1e-999",
    "nan",
    "inf",
    "9223372036854775808",
    "0xFFFFFFFFFFFFFFFFFF",
    "1e18",
    "false",
    "true",
    "\"\"",
    "\"circle\"",
    "\"reynolds\"",
    "\"sea\"",
    "\"munk\"",
    "[1, 1]",
    "[]",
    "[[]]",
    "[[1, 2]]",
    "{}",
    "{ name = 1 }",
    "1979-05-27",
    "é",
    "\u{1F41F}",
    "\0",
    "\r\n",
    "\t",
    "\"\"\"",
    "'",
    "#",
    "=",
    "[",
    "]",
    "{",
    "}",
    "[[group]]\n",
    "[kind.a]\nlike = \"a\"\n",
    "[clock]\nx = 1\n",
    "group = 3\n",
    "\u{202E}",
    "\u{FEFF}",
    "a.b.c = 1\n",
];

/// A scenario that says nearly everything about its modems.
const MODEMS: &str = r#"
name = "modems"
duration_s = 10
[environment]
area_m = [[0, 300], [0, 400], [-1200, 0]]
level = "sea"
[[group]]
name = "slotted"
count = 3
[group.modem]
like = "popoto"
source_level_db = 180
centre_hz = 25000
bandwidth_hz = 8000
bit_rate_bit_s = 640
preamble_s = 0.2
modulation = "bpsk"
addresses = 4
frame_bytes = 40
duty_cycle = { period_s = 10, awake_s = 6 }
access = { name = "slotted", slot_s = 2.5, slots = 9, guard_range_m = 1200 }
[[group]]
name = "csma"
count = 3
[group.modem]
like = "seatrac"
ping_period_s = 20
access = { name = "csma", listen_s = 0.5, backoff_s = 5 }
[[group]]
name = "aloha"
count = 3
modem = { like = "micromodem-fsk", access = "aloha", timestamp_error_s = 1e-3 }
"#;

fn mutate(text: &str, draws: &mut Draws) -> String {
    let mut text = text.to_string();
    for _ in 0..=draws.below(3) {
        match draws.below(4) {
            // A value becomes another value.
            0 => {
                let values: Vec<usize> = text.match_indices("= ").map(|(at, _)| at + 2).collect();
                if let Some(&at) = values.get(draws.below(values.len())) {
                    let end = text[at..].find(['\n', ',', '#']).map_or(text.len(), |end| at + end);
                    text.replace_range(at..end, PIECES[draws.below(PIECES.len())]);
                }
            }
            // A line goes, or comes twice.
            1 => {
                let mut lines: Vec<&str> = text.split_inclusive('\n').collect();
                let line = draws.below(lines.len());
                let to = draws.below(lines.len());
                if draws.below(2) == 0 && line < lines.len() {
                    lines.remove(line);
                } else if let Some(&again) = lines.get(line) {
                    lines.insert(to, again);
                }
                text = lines.concat();
            }
            // Something is put in anywhere.
            2 => {
                let at = text.floor_char_boundary(draws.below(text.len() + 1));
                text.insert_str(at, PIECES[draws.below(PIECES.len())]);
            }
            // A stretch is cut out.
            _ => {
                let start = text.floor_char_boundary(draws.below(text.len() + 1));
                let end = text.ceil_char_boundary((start + draws.below(40)).min(text.len()));
                text.replace_range(start..end, "");
            }
        }
    }
    text
}

#[test]
fn what_is_mutated_is_good() {
    parse("sea.toml", SEA).unwrap_or_else(|errors| panic!("{errors}"));
}

#[test]
fn no_mutation_of_a_scenario_makes_the_parser_panic() {
    let mut draws = Draws(1);
    let (mut good, mut bad) = (0, 0);
    let originals: Vec<&str> = library().iter().map(|entry| entry.text).chain([MODEMS, SEA, SEA]).collect();
    for round in 0..4000 {
        let original = originals[draws.below(originals.len())];
        let text = mutate(original, &mut draws);
        match parse("mutated.toml", &text) {
            Ok(scenario) => {
                good += 1;
                assert!(scenario.warnings().iter().all(|warning| !warning.to_string().is_empty()));
                let count = 1 + draws.below(70_000) as u32;
                let _ = Overrides { auvs: Some(count), window_ms: Some(91.0), ..Overrides::default() }
                    .apply(scenario);
            }
            Err(errors) => {
                bad += 1;
                assert!(!errors.errors.is_empty(), "round {round}: refused without a reason:\n{text}");
                // Drawing is the slow part in a debug build.
                if round % 8 == 0 {
                    assert!(!errors.render(round % 16 == 0).is_empty());
                }
            }
        }
    }
    assert!(good > 100 && bad > 1000, "{good} good and {bad} bad mutations prove little");
}

#[test]
fn the_modems_are_good_before_they_are_mutated() {
    assert_eq!(parse("modems.toml", MODEMS).map(|scenario| scenario.auv_count()), Ok(9));
}

#[test]
fn noise_is_refused() {
    let mut draws = Draws(2);
    for _ in 0..500 {
        let text: String = (0..draws.below(60)).map(|_| PIECES[draws.below(PIECES.len())]).collect();
        if let Err(errors) = parse("noise.toml", &text) {
            assert!(errors.to_string().contains("noise.toml"));
        }
    }
    let deep = "[".repeat(100_000);
    assert!(parse("deep.toml", &format!("a = {deep}")).is_err());
    assert!(parse("deep.toml", &format!("{}1", "a.".repeat(50_000))).is_err());
    assert!(parse("empty.toml", "").is_err());
}

#[test]
fn a_great_many_errors_take_no_great_time() {
    let unknown: String = (0..30_000).map(|key| format!("key_{key} = 0\n")).collect();
    let groups = "[[group]]\nname = \"a\"\ncount = 1\ncontroller = \"reynolds\"\n".repeat(20_000);
    let kinds: String =
        (0..20_000).map(|kind| format!("[kind.k{kind}]\nlike = \"k{}\"\n", kind + 1)).collect();
    for text in [unknown, groups, kinds] {
        let errors = parse("many.toml", &text).unwrap_err();
        assert!(errors.errors.len() + errors.omitted >= 3, "{errors}");
    }
}
