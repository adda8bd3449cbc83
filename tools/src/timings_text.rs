//! Where a run's time went, as a graph for people.

use std::fmt::{self, Write};

use shoal_bus::summary::{Phase, Timings};

/// Columns of a bar that is all of it.
const BAR: f64 = 60.0;

/// The letters that bars are made of, in the order of the phases.
const LETTERS: [char; 6] = ['#', 'w', 'r', '.', 'g', 'a'];

/// A line for each phase, and a bar for each stretch of the run.
pub fn render(timings: &Timings) -> String {
    let mut text = String::new();
    // Writing to a string does not fail.
    let _infallible = write_all(&mut text, timings);
    text
}

fn write_all(text: &mut String, timings: &Timings) -> fmt::Result {
    let Timings { windows, total_ms, phases, over_time, cpu } = timings;
    writeln!(text, "where the time of {windows} windows went ({:.2} s), in ms per window", total_ms * 1e-3)?;
    writeln!(text, "    {:<9} {:>9} {:>9} {:>9} {:>7}", "", "median", "95 %", "max", "share")?;
    for line in phases {
        writeln!(
            text,
            "  {} {:<9} {:>9.3} {:>9.3} {:>9.3} {:>5.1} %  {}",
            LETTERS[line.phase as usize],
            line.phase.name(),
            line.median_ms,
            line.p95_ms,
            line.max_ms,
            line.share * 100.0,
            bar(line.phase, line.share * BAR),
        )?;
    }
    let longest_ms = over_time.iter().map(|stretch| stretch.mean_ms.iter().sum()).fold(0.0_f64, f64::max);
    writeln!(text, "  over the run: true time, ms per window")?;
    for stretch in over_time {
        let sum_ms: f64 = stretch.mean_ms.iter().sum();
        let bars = stacked(&stretch.mean_ms, BAR / longest_ms.max(1e-9));
        writeln!(text, "  {:>9.2} s {sum_ms:>9.3}  {bars}", stretch.from_s)?;
    }
    if let Some(cpu) = cpu {
        writeln!(
            text,
            "  processors    {:.1} us per AUV and simulated second, {:.1} of them the channel's; {:.2} context switches per wake",
            cpu.us_per_auv_s, cpu.channel_us_per_auv_s, cpu.switches_per_wake
        )?;
    }
    Ok(())
}

fn bar(phase: Phase, columns: f64) -> String {
    LETTERS[phase as usize].to_string().repeat(columns.round() as usize)
}

/// The phases' bars one after the other; rounded where they end, so that their sum keeps its length.
fn stacked(of: &[f64; 6], columns_per_ms: f64) -> String {
    let (mut text, mut end) = (String::new(), 0.0);
    for (length_ms, letter) in of.iter().zip(LETTERS) {
        end += length_ms * columns_per_ms;
        while (text.len() as f64) < end.round() {
            text.push(letter);
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use shoal_bus::summary::{Cpu, PhaseLine, Stretch};

    use super::*;

    #[test]
    fn a_graph_reads_well() {
        let shares = [0.25, 0.1, 0.05, 0.5, 0.05, 0.05];
        let line = |phase: Phase| {
            let share = shares[phase as usize];
            PhaseLine { phase, median_ms: share * 4.0, p95_ms: share * 5.0, max_ms: share * 20.0, share }
        };
        let stretch =
            |from_s: f64, scale: f64| Stretch { from_s, mean_ms: shares.map(|share| share * scale) };
        let timings = Timings {
            windows: 334,
            total_ms: 1336.0,
            phases: Phase::ALL.map(line).to_vec(),
            over_time: vec![stretch(0.09, 5.0), stretch(15.03, 3.0)],
            cpu: Some(Cpu { us_per_auv_s: 123.4, channel_us_per_auv_s: 61.7, switches_per_wake: 1.25 }),
        };
        let expected = [
            "where the time of 334 windows went (1.34 s), in ms per window",
            "                 median      95 %       max   share",
            "  # channel       1.000     1.250     5.000  25.0 %  ###############",
            "  w wake          0.400     0.500     2.000  10.0 %  wwwwww",
            "  r record        0.200     0.250     1.000   5.0 %  rrr",
            "  . agents        2.000     2.500    10.000  50.0 %  ..............................",
            "  g gather        0.200     0.250     1.000   5.0 %  ggg",
            "  a accept        0.200     0.250     1.000   5.0 %  aaa",
            "  over the run: true time, ms per window",
            "       0.09 s     5.000  ###############wwwwwwrrr..............................gggaaa",
            "      15.03 s     3.000  #########wwwwr..................ggaa",
            "  processors    123.4 us per AUV and simulated second, 61.7 of them the channel's; 1.25 context switches per wake",
        ];
        assert_eq!(render(&timings).lines().collect::<Vec<_>>(), expected);
    }
}
