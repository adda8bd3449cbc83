//! Scenarios with an unknown key in every table: the errors then say which keys there are.

/// One unknown key in every table, too unlike any key to be taken for a slip: the fix then lists the keys there are.
pub const UNKNOWN_EVERYWHERE: &str = r#"
name = "all"
duration_s = 1
zz = 0
[environment]
area_m = [[0, 9], [0, 9], [-9, 0]]
zz = 0
[kind.a]
like = "lauv"
zz = 0
[clock.a]
like = "tcxo"
zz = 0
[sabotage]
shifted_truth = { auv = 0, at_s = 0, zz = 0 }
zz = 0
[[group]]
name = "hold"
count = 1
estimator = { name = "tube", zz = 0 }
relative = { measures = "range", zz = 0 }
controller = { name = "hold", zz = 0 }
zz = 0
[group.sensors]
zz = 0
[group.sensors.gnss]
zz = 0
[group.modem]
access = { name = "csma", listen_s = 1, backoff_s = 1, zz = 0 }
duty_cycle = { period_s = 1, awake_s = 1, zz = 0 }
zz = 0
[group.start]
zz = 0
[[group]]
name = "circle"
count = 1
modem.access = { name = "slotted", slot_s = 1, zz = 0 }
controller = { name = "circle", centre_m = [4, 4, -4], radius_m = 1, rate_rad_s = 0.1, zz = 0 }
[[group]]
name = "waypoints"
count = 1
controller = { name = "waypoints", points_m = [[1, 1, -1]], zz = 0 }
[[group]]
name = "reynolds"
count = 1
controller = { name = "reynolds", zz = 0 }
"#;

/// The tables of the water, and of what senses it.
pub const UNKNOWN_IN_THE_SEA: &str = r#"
name = "sea"
duration_s = 1
[environment]
area_m = [[0, 9], [0, 9], [-9, 0]]
level = "sea"
current_field = { name = "shear", surface_m_s = [1, 0, 0], deep_m_s = [0, 0, 0], depth_m = 1, zz = 0 }
[environment.sea]
sound_speed = { depths_m = [0, 9], speeds_m_s = [1500, 1500], zz = 0 }
bottom = { density_kg_m3 = 1900, sound_speed_m_s = 1650, attenuation_db_wavelength = 0.8, zz = 0 }
fading = { kind = "rician", zz = 0 }
zz = 0
[sensors.a]
like = "nominal"
dvl = { altitude_max_m = 1, velocity_error_m_s = 1, zz = 0 }
zz = 0
[[group]]
name = "hold"
count = 1
modem = "micromodem-psk"
"#;

/// What cannot stand beside other forms of the same table.
pub const UNKNOWN_IN_OTHER_FORMS: &str = r#"
name = "other"
duration_s = 1
[environment]
area_m = [[0, 9], [0, 9], [-9, 0]]
level = "sea"
current_field = { name = "vortex", centre_m = [4, 4], core_radius_m = 1, speed_m_s = 1, zz = 0 }
sea.sound_speed = { depths_m = [0, 9], temperatures_c = [9, 9], salinities_psu = [35, 35], zz = 0 }
[[fault]]
kind = "kidnap"
auv = 0
at_s = 0
to_m = [1, 1, -1]
zz = 0
[[group]]
name = "station"
count = 1
controller = { name = "station", zz = 0 }
start.grid = { first_m = [1, 1, -1], spacing_m = [1, 1, 0], columns = 1, zz = 0 }
modem = "micromodem-psk"
[[group]]
name = "hold"
count = 1
estimator = { name = "tube", outliers = { tolerated = 1, zz = 0 } }
modem = "micromodem-psk"
"#;
