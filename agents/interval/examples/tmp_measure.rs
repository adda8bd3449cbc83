use nalgebra::Vector2;
use shoal_interval::paving::{Options, pave};
use shoal_interval::separator::{Ring, Separator, intersection};
use shoal_interval::{Interval, IntervalBox};
fn main() {
    let ring = |x, y, a, b| Ring::new(Vector2::new(x, y), Interval::new(a, b).unwrap());
    let rings = [ring(3.0, 3.0, 3.0, 4.0), ring(-3.0, -1.0, 5.0, 6.0), ring(-2.0, 2.0, 4.0, 5.0)];
    let initial = IntervalBox::from([Interval::new(-10.0, 10.0).unwrap(); 2]);
    let s = intersection_of(rings);
    for eps in [0.05, 0.04, 0.03] {
        let p = pave(&s, initial, &Options::new(eps)).unwrap();
        println!(
            "{eps} {:?} in {} out {} parts {} boundary {}",
            p.statistics(),
            p.inner_volume().lower(),
            p.outer_volume().upper(),
            p.parts(),
            p.boundary().len()
        );
    }
    let p = pave(&s, initial, &Options::new(0.05)).unwrap();
    let t = std::time::Instant::now();
    let n = 2000;
    let mut tests = 0;
    for _ in 0..n {
        tests += pave(&s, std::hint::black_box(initial), &Options::new(0.05)).unwrap().statistics().boxes;
    }
    println!("{} ns per separation (sivia)", t.elapsed().as_nanos() as f64 / tests as f64);
    let t = std::time::Instant::now();
    let mut k = 0;
    for _ in 0..n {
        for b in p.boundary() {
            let x = s.separate(std::hint::black_box(*b));
            if x.inner.is_empty() {
                k += 1
            }
        }
    }
    println!(
        "{} ns per separation (boundary, both) {k}",
        t.elapsed().as_nanos() as f64 / (n * p.boundary().len()) as f64
    );
    let t = std::time::Instant::now();
    for _ in 0..n {
        for b in p.boundary() {
            let x = rings[0].separate(std::hint::black_box(*b));
            if x.inner.is_empty() {
                k += 1
            }
        }
    }
    println!(
        "{} ns per ring separation {k}",
        t.elapsed().as_nanos() as f64 / (n * p.boundary().len()) as f64
    );
}
