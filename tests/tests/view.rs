//! `shoal view`, in a browser as people use it, and as others must not.
//!
//! Pictures of what the browser showed are left in `target/view/`; those whose name begins with `view-` are in `tools/docs` as well. Without Chromium, what needs it is skipped and says so.

use std::fs::File;
use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::path::{Path, PathBuf};
use std::process::{Child, Stdio};

use rustix::process::Signal;
use serde_json::Value;
use shoal_bus::record::{Row, Topic, read_rows};
use shoal_tests::{Chromium, Command, await_that, shoal};

/// `shoal view ARGUMENTS` in progress. It must end well when it is interrupted.
struct View {
    child: Child,
    url: String,
    temporary: tempfile::TempDir,
}

impl View {
    fn start(arguments: &[&str], record: Option<&Path>) -> Self {
        let temporary = tempfile::tempdir().unwrap();
        let mut child = std::process::Command::new(shoal())
            .arg("view")
            .args(arguments)
            .args(record)
            .args(["--no-open", "--json"])
            .env("TMPDIR", temporary.path())
            .env_remove("SSH_CONNECTION")
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        let mut line = String::new();
        BufReader::new(child.stdout.take().unwrap()).read_line(&mut line).unwrap();
        let told: Value = serde_json::from_str(&line).unwrap_or_else(|error| panic!("{error}: {line:?}"));
        assert_eq!(told["format"], "shoal.view/1");
        Self { child, url: told["url"].as_str().unwrap().to_owned(), temporary }
    }

    /// The address with a moment and more behind it.
    fn at(&self, hash: &str) -> String {
        format!("{}#{hash}", self.url)
    }

    /// What the server answers to a request for `path` with these headers.
    fn asked(&self, path: &str, headers: &str) -> String {
        let host = self.url.split('/').nth(2).unwrap();
        let mut stream = TcpStream::connect(host).unwrap();
        stream.write_all(format!("GET {path} HTTP/1.1\r\n{headers}\r\n").as_bytes()).unwrap();
        let mut answer = String::new();
        stream.read_to_string(&mut answer).unwrap();
        answer
    }

    fn end(mut self) {
        let pid = i32::try_from(self.child.id()).unwrap();
        rustix::process::kill_process(rustix::process::Pid::from_raw(pid).unwrap(), Signal::INT).unwrap();
        assert_eq!(self.child.wait().unwrap().code(), Some(0));
        assert_eq!(std::fs::read_dir(self.temporary.path()).unwrap().count(), 0);
    }
}

impl Drop for View {
    fn drop(&mut self) {
        let _ended = self.child.kill();
        let _reaped = self.child.wait();
    }
}

fn recorded(folder: &Path, run: &str) -> PathBuf {
    let record = folder.join("run.mcap");
    Command::new("run").and(run).and("--bus local --quiet --record").with(&record).finish().succeeded();
    record
}

fn open(url: &str) -> Option<Chromium> {
    let page = Chromium::open(url, 1280, 800);
    if page.is_none() {
        eprintln!("skipped: there is no Chromium here");
    }
    page
}

/// Waits until all is read and the moment is shown.
fn await_shown(page: &mut Chromium) {
    page.await_that("window.shoal?.facts.done && shoal.facts.ready && shoal.facts.frames > 1");
}

fn facts(page: &mut Chromium) -> Value {
    page.value("shoal.facts")
}

/// Waits until what was changed has been drawn.
fn settle(page: &mut Chromium) {
    page.value("new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(() => setTimeout(done, 50))))");
}

/// How many pixels of the water in the picture `file` are about so red, green and blue.
fn pixels(page: &mut Chromium, file: &Path, [red, green, blue]: [u8; 3]) -> u64 {
    let bytes: Vec<String> = std::fs::read(file).unwrap().iter().map(u8::to_string).collect();
    let count = format!(
        "(async () => {{
            const bitmap = await createImageBitmap(new Blob([new Uint8Array([{}])], {{ type: 'image/png' }}));
            const {{ left, top, width, height }} = document.getElementById('water').getBoundingClientRect();
            const pen = new OffscreenCanvas(width, height).getContext('2d');
            pen.drawImage(bitmap, -left, -top);
            const {{ data }} = pen.getImageData(0, 0, width, height);
            let count = 0;
            for (let at = 0; at < data.length; at += 4) {{
                const far = Math.abs(data[at] - {red}) + Math.abs(data[at + 1] - {green}) + Math.abs(data[at + 2] - {blue});
                if (far < 90) count++;
            }}
            return count;
        }})()",
        bytes.join(",")
    );
    page.value(&count).as_u64().unwrap()
}

#[test]
fn the_swarm_is_seen_in_layers_and_panes() {
    let folder = tempfile::tempdir().unwrap();
    let record = recorded(folder.path(), "swarm-1000 --duration 3");
    let view = View::start(&[], Some(&record));
    let Some(mut page) = open(&view.at("t=2&theme=dark&layers=bodies,links,boxes,waves")) else { return };
    await_shown(&mut page);
    settle(&mut page);
    let shown = facts(&mut page);
    let counts = &shown["counts"];
    assert_eq!((&counts["bodies"], &counts["boxes"]), (&1000.into(), &1000.into()), "{shown}");
    assert!(counts["waves"].as_u64().unwrap() > 50, "{shown}");
    assert_eq!(shown["calls"], 5, "bodies, boxes, links, wavefronts and the frame: {shown}");
    let links = counts["links"].as_f64().unwrap();
    let expected = pairs_in_range(&record, 2.0);
    // At a whole second, but between ticks: who is just at the edge of a range may count or not.
    assert!((links - expected).abs() <= 0.002 * expected, "{links} links, {expected} by the record");

    // Okabe and Ito's sky blue, bluish green and vermilion are there.
    let all = page.picture("swarm-1000-layers");
    let colours = [[86, 180, 233], [0, 158, 115], [213, 94, 0]];
    for colour in colours {
        let seen = pixels(&mut page, &all, colour);
        assert!(seen > 1000, "{seen} pixels of {colour:?}");
    }
    for key in ["2", "3", "4"] {
        page.press(key);
    }
    settle(&mut page);
    assert_eq!(facts(&mut page)["calls"], 2);
    let bodies = page.picture("swarm-1000-bodies");
    for colour in colours {
        assert!(pixels(&mut page, &bodies, colour) > 300, "{colour:?}");
    }
    page.press("1");
    settle(&mut page);
    let empty = page.picture("swarm-1000-empty");
    assert!(pixels(&mut page, &empty, colours[2]) < 30);

    page.press("p");
    settle(&mut page);
    page.await_that("document.querySelectorAll('#labels .pane').length === 4");
    // Each pane has the frame, the bodies, and what it is for.
    assert_eq!(facts(&mut page)["calls"], 2 + 3 + 3 + 3);
    let panes = page.picture("swarm-1000-panes");
    assert!(pixels(&mut page, &panes, colours[0]) > 1000);
    page.small_picture("view-panes");

    // How fast it is, for people.
    page.value("document.activeElement.blur(); shoal.from = [performance.now(), shoal.facts.frames]");
    for key in ["p", "1", "2", "3", "4", "Home", " "] {
        page.press(key);
    }
    std::thread::sleep(std::time::Duration::from_secs(2));
    let rate = page.value("1e3 * (shoal.facts.frames - shoal.from[1]) / (performance.now() - shoal.from[0])");
    println!("1,000 AUVs with all layers: {:.1} pictures a second", rate.as_f64().unwrap());
    assert_eq!(page.complaints(), [""; 0]);
    drop(page);
    view.end();
}

/// Unordered pairs of which one hears the other, as the record has positions and ranges at `t_s`.
fn pairs_in_range(record: &Path, t_s: f64) -> f64 {
    let mut places = vec![[f64::NAN; 3]; 1000];
    let mut groups = Vec::new();
    let mut earliest = vec![f64::INFINITY; 1000];
    read_rows(File::open(record).unwrap(), &[Topic::Ticks], &mut |row| match row {
        Row::Header(header) => groups = header.auvs.iter().map(|auv| auv.group).collect(),
        Row::Truth(row) if (row.t_ns.as_s() - t_s).abs() < earliest[row.auv.0 as usize] => {
            earliest[row.auv.0 as usize] = (row.t_ns.as_s() - t_s).abs();
            places[row.auv.0 as usize] = row.position_m.map(|metres| metres.0);
        }
        _ => {}
    })
    .unwrap();
    // swarm-1000: blue, green and red.
    let range = |auv: usize| [250.0, 120.0, 400.0][usize::from(groups[auv])];
    let mut pairs = 0;
    for one in 0..places.len() {
        for other in 0..one {
            let squares: f64 = places[one].iter().zip(places[other]).map(|(a, b)| (a - b) * (a - b)).sum();
            pairs += u32::from(squares.sqrt() <= f64::max(range(one), range(other)));
        }
    }
    f64::from(pairs)
}

#[test]
fn an_auv_is_selected_and_charted() {
    let folder = tempfile::tempdir().unwrap();
    let record = recorded(folder.path(), "six-circles --duration 30");
    let view = View::start(&[], Some(&record));
    let Some(mut page) = open(&view.at("t=25&theme=light")) else { return };
    await_shown(&mut page);
    assert_eq!(page.value("document.querySelectorAll('#list [data-auv]').length"), 6);
    assert_eq!(page.value("document.querySelectorAll('#groups button').length"), 2);
    assert_eq!(page.value("document.getElementById('scenario').textContent"), "six-circles");

    let place = page.value("shoal.place(3)");
    page.click(place[0].as_f64().unwrap(), place[1].as_f64().unwrap());
    page.await_that("shoal.facts.selected >= 0");
    let selected = facts(&mut page)["selected"].as_u64().unwrap();
    // Whoever it is, it is where the click was: two may swim close by.
    let at = page.value(&format!("shoal.place({selected})"));
    let far = |axis: usize| (at[axis].as_f64().unwrap() - place[axis].as_f64().unwrap()).abs();
    assert!(far(0) < 15.0 && far(1) < 15.0, "{selected}: {at} instead of {place}");

    page.press("/");
    page.write("deep-0");
    page.press("Enter");
    page.await_that("shoal.facts.selected === 3 && shoal.facts.rows > 0");
    let ticks = ticks_of(&record, 3);
    page.await_that(&format!("shoal.facts.rows === {ticks}"));
    page.await_that("document.querySelector('#right h2').textContent === 'deep-0'");
    page.await_that("document.querySelector('#right .good')?.textContent.startsWith('at all')");
    assert_eq!(page.value("document.querySelector('#list [aria-current]').dataset.auv"), "3");
    // The charts are drawn: none is blank.
    let drawn = "[...document.querySelectorAll('#right canvas')].map((chart) => chart.getContext('2d')
        .getImageData(0, 0, chart.width, chart.height).data.filter((part, at) => at % 4 === 3 && part > 40).length)";
    let drawn: Vec<u64> = serde_json::from_value(page.value(drawn)).unwrap();
    assert!(drawn.len() >= 4 && drawn.iter().all(|pixels| *pixels > 300), "{drawn:?}");
    page.press("r");
    settle(&mut page);
    page.picture("six-circles-selected");
    page.small_picture("view-tube");

    // All four tubes, and relative to the truth.
    for (presses, axis) in [("a", "y"), ("a", "z"), ("a", "clock"), ("a", "x")] {
        page.press(presses);
        page.await_that(&format!(
            "document.querySelector('.tabs [aria-pressed=true]').textContent === '{axis}'"
        ));
    }
    page.press("t");
    page.await_that("document.querySelectorAll('.tabs [aria-pressed=true]').length === 2");
    page.press("Escape");
    page.await_that(
        "shoal.facts.selected === -1 && document.querySelector('#right h2').textContent === 'Swarm of 6'",
    );
    assert_eq!(page.complaints(), [""; 0]);
    drop(page);
    view.end();
}

fn ticks_of(record: &Path, auv: u32) -> u64 {
    let mut ticks = 0;
    read_rows(File::open(record).unwrap(), &[Topic::Ticks], &mut |row| {
        ticks += u64::from(matches!(row, Row::Truth(row) if row.auv.0 == auv));
    })
    .unwrap();
    ticks
}

#[test]
fn time_goes_by_keys_and_slider() {
    let folder = tempfile::tempdir().unwrap();
    let record = recorded(folder.path(), "thermocline --duration 40");
    let view = View::start(&[], Some(&record));
    let Some(mut page) = open(&view.at("t=5&theme=dark")) else { return };
    await_shown(&mut page);
    let time = |page: &mut Chromium| facts(page)["t"].as_f64().unwrap();
    page.press("ArrowRight");
    assert!((time(&mut page) - 5.1).abs() < 1e-9);
    page.press("Home");
    assert_eq!(time(&mut page), 0.0);
    page.press(" ");
    page.await_that("shoal.facts.playing && shoal.facts.t > 0.3");
    page.press(" ");
    assert_eq!(facts(&mut page)["playing"], false);
    page.press("+");
    assert_eq!(facts(&mut page)["rate"], 3);
    page.press("End");
    assert!(time(&mut page) > 39.0);
    let slide = "const slider = document.getElementById('scrub'); slider.value = 31.5; slider.dispatchEvent(new Event('input'))";
    page.value(slide);
    page.await_that("Math.abs(shoal.facts.t - 31.5) < 0.01 && shoal.facts.ready");
    // At sea, links are those who heard each other.
    assert_eq!(page.value("document.getElementById('links-name').textContent"), "Links heard lately");
    page.await_that("shoal.facts.counts.links > 100");

    page.press("d");
    assert_eq!(facts(&mut page)["theme"], "light");
    page.press("?");
    page.await_that("document.getElementById('help').open");
    let keys = page.value("document.querySelectorAll('#keys dt').length").as_u64().unwrap();
    assert!(keys >= 18, "{keys}");
    page.press("?");
    page.await_that("!document.getElementById('help').open");
    page.picture("thermocline");
    // A group that is hidden is hidden, and nobody in it can be hit.
    page.value("document.querySelector('#groups button').click()");
    settle(&mut page);
    assert!(facts(&mut page)["counts"]["bodies"].as_u64().unwrap() < 24);
    assert_eq!(page.complaints(), [""; 0]);
    drop(page);
    view.end();
}

#[test]
fn a_live_run_is_followed_to_its_end() {
    let mut run = Command::new("run swarm-3 --pace 4 --quiet --json").start();
    let id = run.await_pings(3);
    let view = View::start(&["--live", "--run", &id], None);
    let page = open(&view.at("theme=dark"));
    if let Some(mut page) = page {
        page.await_that(
            "window.shoal?.facts.following && shoal.facts.end > 4 && shoal.facts.counts?.bodies === 3",
        );
        page.press("n");
        page.await_that("shoal.facts.rows > 10");
        let rows = facts(&mut page)["rows"].as_u64().unwrap();
        page.await_that(&format!("shoal.facts.rows > {rows}"));
        page.picture("live");
        let first = facts(&mut page)["t"].as_f64().unwrap();
        page.await_that(&format!("shoal.facts.t > {first} + 1"));
        page.await_that("shoal.facts.done");
        assert_eq!(facts(&mut page)["note"], "The run is over.");
        assert_eq!(page.complaints(), [""; 0]);
    }
    let summary = run.finish().succeeded().json();
    assert_eq!(summary["digest"], Command::new("run swarm-3 --bus local").json()["digest"]);
    view.end();
}

#[test]
fn an_exported_page_needs_nobody() {
    let folder = tempfile::tempdir().unwrap();
    let record = recorded(folder.path(), "swarm-3 --duration 5");
    let file = folder.path().join("page.html");
    Command::new("view").with(&record).and("--export").with(&file).finish().succeeded();
    let text = std::fs::read_to_string(&file).unwrap();
    assert!(!text.contains("src=\"view.js\"") && text.contains("Permission is hereby granted"));
    let Some(mut page) = open(&format!("file://{}#t=3&auv=1", file.display())) else { return };
    await_shown(&mut page);
    page.await_that("shoal.facts.counts.bodies === 3 && shoal.facts.selected === 1");
    page.await_that(&format!("shoal.facts.rows === {}", ticks_of(&record, 1)));
    page.picture("exported");
    assert_eq!(page.complaints(), [""; 0]);
}

#[test]
fn what_cannot_be_shown_is_said() {
    let folder = tempfile::tempdir().unwrap();
    let record = recorded(folder.path(), "swarm-3 --duration 5");
    let whole = std::fs::read(&record).unwrap();
    let cut = folder.path().join("cut.mcap");
    std::fs::write(&cut, &whole[..whole.len() / 2]).unwrap();
    let refused = |command: Command, code: i32, words: &str| {
        let finished = command.finish();
        assert!(finished.code() == Some(code) && finished.stderr.contains(words), "{finished:?}");
    };
    refused(Command::new("view missing.mcap"), 1, "missing.mcap");
    refused(Command::new("view"), 2, "<RECORD>");
    refused(Command::new("view --live --run 00000000"), 1, "no live run has the id");
    std::fs::write(folder.path().join("text"), "not a record").unwrap();
    refused(Command::new("view").with(folder.path().join("text")), 1, "MCAP");
    let page = folder.path().join("page.html");
    let exported = Command::new("view").with(&cut).and("--export").with(&page).finish().exited(3);
    assert!(exported.stderr.contains("cut"), "{exported:?}");

    let view = View::start(&[], Some(&cut));
    let taken = view.url.split([':', '/']).nth(4).unwrap().to_owned();
    refused(Command::new("view").with(&record).and("--port").with(&taken), 2, &taken);
    if let Some(mut page) = open(&view.at("t=1")) {
        await_shown(&mut page);
        page.await_that("!document.getElementById('note').hidden");
        assert_eq!(facts(&mut page)["note"], "The record was cut: this is all that is in it.");
    }
    view.end();
}

#[test]
fn only_who_knows_the_address_is_served() {
    let folder = tempfile::tempdir().unwrap();
    let view = View::start(&[], Some(&recorded(folder.path(), "swarm-3 --duration 1")));
    let (_, path) = view.url.strip_prefix("http://").unwrap().split_once('/').unwrap();
    let path = format!("/{path}");
    let status = |path: &str, headers: &str| view.asked(path, headers).split(' ').nth(1).unwrap().to_owned();
    let page = view.asked(&path, "Host: 127.0.0.1\r\n");
    assert!(
        page.starts_with("HTTP/1.1 200") && page.contains("Content-Security-Policy: default-src 'none'"),
        "{page}"
    );
    assert_eq!(status(&format!("{path}view.js"), "Host: localhost:1\r\n"), "200");
    assert_eq!(status(&path, "Host: evil.example\r\n"), "403");
    assert_eq!(status(&path, ""), "403");
    assert_eq!(status("/", "Host: 127.0.0.1\r\n"), "404");
    assert_eq!(status(&format!("{path}..%2f..%2fetc%2fpasswd"), "Host: 127.0.0.1\r\n"), "404");
    let socket = "Host: 127.0.0.1\r\nConnection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\n\
                  Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n";
    let foreign = format!("{socket}Origin: http://evil.example\r\n");
    assert_eq!(status(&format!("{path}socket"), &foreign), "403");
    assert_eq!(status(&format!("{path}socket"), "Host: 127.0.0.1\r\nOrigin: http://127.0.0.1\r\n"), "400");
    // Nonsense is answered, too, and costs the others nothing.
    assert_eq!(status("\u{7f}", ""), "400");
    assert_eq!(status(&path, "Host: 127.0.0.1\r\n"), "200");
    view.end();
}

#[test]
fn the_page_is_made_of_its_sources() {
    let sources = shoal_tests::workspace().join("tools/view");
    let folder = tempfile::tempdir().unwrap();
    let copied = std::process::Command::new("cp")
        .arg("-r")
        .args(["package.json", "package-lock.json", "build.mjs", "src"].map(|name| sources.join(name)))
        .arg(folder.path())
        .status()
        .unwrap();
    assert!(copied.success());
    let npm = |arguments: &[&str]| {
        let mut command = std::process::Command::new("npm");
        command.args(arguments).current_dir(folder.path()).output()
    };
    match npm(&["ci", "--no-audit", "--no-fund"]) {
        Ok(output) if output.status.success() => {}
        Ok(output) => {
            return eprintln!(
                "skipped: npm cannot fetch three and esbuild: {}",
                String::from_utf8_lossy(&output.stderr)
            );
        }
        Err(error) => return eprintln!("skipped: no npm here: {error}"),
    }
    let built = npm(&["run", "build"]).unwrap();
    assert!(built.status.success(), "{}", String::from_utf8_lossy(&built.stderr));
    for name in ["view.js", "LICENSES.txt"] {
        let [made, kept] =
            [folder.path(), &sources].map(|place| std::fs::read(place.join("dist").join(name)).unwrap());
        assert!(
            made == kept,
            "{name}: run `npm ci && npm run build` in tools/view and commit what it changes"
        );
    }
    let script = std::fs::metadata(sources.join("dist/view.js")).unwrap().len();
    assert!(script < 800_000, "{script} bytes");
}

#[test]
fn several_pages_can_look_at_once() {
    let folder = tempfile::tempdir().unwrap();
    let view = View::start(&[], Some(&recorded(folder.path(), "swarm-3 --duration 2")));
    let host = view.url.split('/').nth(2).unwrap().to_owned();
    let origin = format!("http://{host}");
    let address = format!("{}socket", view.url.replace("http://", "ws://"));
    let connect = || {
        use tungstenite::client::IntoClientRequest;
        let mut request = address.as_str().into_client_request().unwrap();
        request.headers_mut().insert("origin", origin.parse().unwrap());
        tungstenite::connect(request).unwrap().0
    };
    let mut sockets: Vec<_> = (0..8).map(|_| connect()).collect();
    for socket in &mut sockets {
        socket.send(tungstenite::Message::text(r#"{"nonsense":1}"#)).unwrap();
        let mut is_done = false;
        await_that("the page is told that all is there", || {
            if let tungstenite::Message::Text(text) = socket.read().unwrap() {
                let told: Value = serde_json::from_str(&text).unwrap();
                is_done |= told["reached"]["done"] == true;
            }
            is_done
        });
        socket.send(tungstenite::Message::text(r#"{"scene":1}"#)).unwrap();
        let tungstenite::Message::Binary(scene) = socket.read().unwrap() else {
            panic!("a scene was expected")
        };
        assert_eq!(scene[..12], [1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0]);
        socket.send(tungstenite::Message::text(r#"{"track":2,"from":0}"#)).unwrap();
        let tungstenite::Message::Binary(track) = socket.read().unwrap() else {
            panic!("a track was expected")
        };
        assert_eq!(track[..8], [2, 0, 0, 0, 2, 0, 0, 0]);
    }
    drop(sockets);
    view.end();
}
