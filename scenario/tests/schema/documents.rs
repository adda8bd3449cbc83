//! Scenarios that have every key, some of which exclude others.

/// Together they have every key in every form.
pub const ALL: &[&str] = &[IDEAL, SEA, WATER];

const IDEAL: &str = r#"
name = "ideal"
summary = "every key at level ideal"
source = "made up"
seed = 3
duration_s = 20
window_ms = 20
knot_ms = 10
noise = "adversarial"
on_crash = "abort"

[environment]
area_m = [[0, 1000], [0, 1000], [-100, 0]]
level = "ideal"
sound_speed_m_s = 1500
sound_speed_error_m_s = 1
current_m_s = [0.1, 0, 0]
current_error_m_s = [0.01, 0.01, 0]
current_field = { name = "vortex", centre_m = [500, 500], core_radius_m = 100, speed_m_s = 0.1 }

[kind.mine]
speed_max_m_s = 2
acceleration_max_m_s2 = 0.3
turn_rate_max_rad_s = 0.35
pitch_max_rad = 0.4
disturbance_m_s = [0.05, 0.05, 0.02]
length_m = 2

[kind.longer]
like = "mine"
length_m = 3

[clock.mine]
drift_bound = 1e-5
wander_fraction = 0.4
offset_bound_s = 0.1

[clock.other]
like = "tcxo"

[sensors.mine]
like = "nominal"
heading_error_rad = 0.01
pitch_error_rad = 0.01
speed_error_m_s = 0.02
depth_error_m = 0.1
dvl = { altitude_max_m = 50, velocity_error_m_s = 0.01 }
gnss = { depth_max_m = 1, period_s = 1, position_error_m = [1, 1, 1], time_error_s = 1e-6 }

[sabotage]
shifted_truth = { auv = 0, at_s = 5 }

[[fault]]
kind = "kidnap"
auv = 1
at_s = 5
to_m = [10, 10, -10]

[[group]]
name = "circlers"
count = 2
kind = { like = "mine", speed_max_m_s = 2, acceleration_max_m_s2 = 0.3, turn_rate_max_rad_s = 0.35, pitch_max_rad = 0.4, disturbance_m_s = [0, 0, 0], length_m = 2 }
clock = { like = "mine", drift_bound = 1e-5, wander_fraction = 0.5, offset_bound_s = 0 }
control_period_s = 0.2
reaction_s = 0.1
sabotage = "lying-ping"
relative = { measures = "range", exchanged = false, remembered = 8 }
estimator = { name = "tube", horizon_s = 12, rings = 4, stopping_ratio = 0.1, on_empty = "relax", outliers = { window = 8, tolerated = 1, margin = 1, inlier_probability = 0.9 } }
controller = { name = "circle", centre_m = [500, 500, -20], radius_m = 50, rate_rad_s = 0.01, phase_rad = 1, heave_m = 2, heave_phase_rad = 0.5 }

[group.sensors]
like = "mine"
heading_error_rad = 0.01
pitch_error_rad = 0.01
speed_error_m_s = 0.02
depth_error_m = false
dvl = { altitude_max_m = 50, velocity_error_m_s = 0.01 }
gnss = { depth_max_m = 1, period_s = 1, position_error_m = [1, 1, 1], time_error_s = 1e-6 }

[group.modem]
like = "evologics-18-34"
range_m = 400
ping_period_s = 2
ping_phase_s = 0.5
timestamp_error_s = 1e-5
bearing_error_rad = 0.1
outlier_rate = 0.01
outlier_delay_s = 0.2
frame_bytes = 64
addresses = 10
access = { name = "periodic" }
duty_cycle = { period_s = 10, awake_s = 8 }
source_level_db = 180
centre_hz = 25000
bandwidth_hz = 5000
bit_rate_bit_s = 1000
preamble_s = 0.1
modulation = "fsk"
coding_gain_db = 3
detection_threshold_db = 1
capture_db = 6

[group.start]
place = "on-circle"
box_width_m = [5, 10]
known = true
speed_m_s = 0.5

[[group]]
name = "walkers"
count = 1
command = ["python3", "agent.py"]
estimator = { name = "ekf", gate_sigma = 4, fusion = "covariance-intersection" }
controller = { name = "waypoints", points_m = [[10, 10, -10], [50, 50, -10]], speed_m_s = 1, reach_m = 4, repeat = false }
modem.access = { name = "csma", listen_s = 0.5, backoff_s = 1 }
start.region_m = [[0, 10], [0, 10], [-20, -10]]
start.heading_rad = 1.5

[[group]]
name = "birds"
count = 2
estimator = { name = "dead-reckoning" }
controller = { name = "reynolds", speed_m_s = 1, separation = 1, cohesion = 1, alignment = 1, margin_m = 5, forget_s = 6, trusts = ["birds"] }
modem.access = { name = "aloha" }
start.points_m = [[100, 100, -10], [200, 200, -10]]

[[group]]
name = "grid"
count = 4
controller = { name = "station", speed_m_s = 1 }
modem.access = { name = "slotted", slot_s = 2, slots = 9, guard_range_m = 400 }
start.grid = { first_m = [100, 100, -20], spacing_m = [50, 50, 5], columns = 2, rows = 2, layers = 2, scatter_m = 1 }

[[group]]
name = "still"
count = 1
estimator = "ekf"
controller = { name = "hold" }
relative = false
modem = "evologics-18-34"
"#;

const SEA: &str = r#"
name = "sea"
duration_s = 10

[environment]
area_m = [[0, 1000], [0, 1000], [-100, 0]]
level = "sea"
current_field = { name = "shear", surface_m_s = [0.1, 0, 0], deep_m_s = [0, 0, 0], depth_m = 50 }

[environment.sea]
bottom_depth_m = 120
sound_speed = { depths_m = [0, 60], speeds_m_s = [1510, 1490] }
temperature_c = 12
salinity_psu = 36
ph = 8
absorption = "ainslie-mccolm"
spreading_exponent = 1.6
shipping = 0.4
wind_m_s = 4
surface_loss_db = 1
bottom = { density_kg_m3 = 1900, sound_speed_m_s = 1650, attenuation_db_wavelength = 0.8 }
bounces_max = 3
fading = { kind = "rician", k_db = 6, per = "bit" }

[[group]]
name = "a"
count = 2
modem = "micromodem-psk"
sensors.gnss = "standalone"
sensors.dvl = false
"#;

const WATER: &str = r#"
name = "water"
duration_s = 10

[environment]
area_m = [[0, 1000], [0, 1000], [-100, 0]]
level = "sea"
current_field = { name = "uniform" }

[environment.sea]
sound_speed = { depths_m = [0, 20, 60], temperatures_c = [22, 21, 13], salinities_psu = [38, 38, 38.3], formula = "mackenzie" }
bottom = "sand"
fading = "rayleigh"

[[group]]
name = "a"
count = 1
modem = { like = "micromodem-psk", ping_period_s = false, bearing_error_rad = false }
controller = "reynolds"
estimator = { name = "tube", outliers = false }
start.box_width_m = 5
"#;

/// Tables with a name of which the others have no unknown key.
pub const UNKNOWN_IN_NAMED_TABLES: &str = r#"
name = "named"
duration_s = 1
[environment]
area_m = [[0, 9], [0, 9], [-9, 0]]
current_field = { name = "uniform", zz = 0 }
[[group]]
name = "a"
count = 1
estimator = { name = "ekf", zz = 0 }
modem.access = { name = "periodic", zz = 0 }
[[group]]
name = "b"
count = 1
estimator = { name = "dead-reckoning", zz = 0 }
modem.access = { name = "aloha", zz = 0 }
"#;
