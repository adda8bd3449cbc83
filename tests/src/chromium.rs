//! A headless Chromium, driven over the DevTools protocol (chromedevtools.github.io/devtools-protocol).

use std::io::{BufRead, BufReader};
use std::net::TcpStream;
use std::path::PathBuf;
use std::process::{Child, Stdio};
use std::time::{Duration, Instant};

use serde_json::{Value, json};
use tungstenite::stream::MaybeTlsStream;
use tungstenite::{Message, WebSocket};

/// Longest that anything is waited for before a test is called stuck; no result depends on it.
const PATIENCE: Duration = Duration::from_secs(90);

/// Programs that are Chromium, by name.
const NAMES: [&str; 4] = ["chromium", "chromium-browser", "google-chrome", "chrome"];

/// One page in a browser of its own, without a GPU. Dropped, the browser ends.
pub struct Chromium {
    browser: Child,
    socket: WebSocket<MaybeTlsStream<TcpStream>>,
    session: String,
    asked: u64,
    /// What went wrong on the page: exceptions and refusals.
    complaints: Vec<String>,
    /// What the browser keeps on disk, until it has ended.
    _profile: tempfile::TempDir,
}

impl Chromium {
    /// Opens `url` in a window of `width` by `height` pixels; `None` when no Chromium is installed.
    ///
    /// # Panics
    /// When the browser does not start as it should.
    pub fn open(url: &str, width: u32, height: u32) -> Option<Self> {
        let program = installed()?;
        let profile = tempfile::tempdir().expect("a temporary folder can be made");
        let mut browser = std::process::Command::new(program)
            .args([
                "--headless=new",
                "--no-sandbox",
                "--use-angle=swiftshader",
                "--enable-unsafe-swiftshader",
            ])
            .args([
                "--remote-debugging-port=0",
                "--no-first-run",
                "--hide-scrollbars",
                "--disable-dev-shm-usage",
            ])
            .arg(format!("--user-data-dir={}", profile.path().display()))
            .arg("about:blank")
            .stdin(Stdio::null())
            .stdout(Stdio::null())
            .stderr(Stdio::piped())
            .spawn()
            .expect("Chromium can be started");
        let mut lines =
            BufReader::new(browser.stderr.take().expect("it is piped")).lines().map_while(Result::ok);
        let address = lines.find_map(|line| Some(line.split_once("DevTools listening on ")?.1.to_owned()));
        // Nobody reads what else it says; it must be able to say it.
        std::thread::spawn(move || lines.for_each(drop));
        let address = address.expect("Chromium tells where it listens");
        let (socket, _) = tungstenite::connect(address).expect("Chromium takes a connection");
        if let MaybeTlsStream::Plain(stream) = socket.get_ref() {
            stream.set_read_timeout(Some(PATIENCE)).expect("a timeout can be set");
        }
        let mut page = Self {
            browser,
            socket,
            session: String::new(),
            asked: 0,
            complaints: Vec::new(),
            _profile: profile,
        };
        let target = page.call("Target.createTarget", json!({ "url": "about:blank" }));
        let attach = json!({ "targetId": target["targetId"], "flatten": true });
        let attached = page.call("Target.attachToTarget", attach);
        page.session = attached["sessionId"].as_str().expect("a session has an id").to_owned();
        for domain in ["Runtime.enable", "Log.enable", "Page.enable"] {
            page.call(domain, json!({}));
        }
        let size = json!({ "width": width, "height": height, "deviceScaleFactor": 1, "mobile": false });
        page.call("Emulation.setDeviceMetricsOverride", size);
        page.call("Page.navigate", json!({ "url": url }));
        Some(page)
    }

    /// The value of a JavaScript expression.
    ///
    /// # Panics
    /// When it throws.
    #[track_caller]
    pub fn value(&mut self, expression: &str) -> Value {
        let ask = json!({ "expression": expression, "returnByValue": true, "awaitPromise": true });
        let answer = self.call("Runtime.evaluate", ask);
        assert!(answer.get("exceptionDetails").is_none(), "{expression}: {answer}");
        answer["result"]["value"].clone()
    }

    /// Waits until a JavaScript expression is true.
    ///
    /// # Panics
    /// When it never is, with what the page says of itself.
    #[track_caller]
    pub fn await_that(&mut self, expression: &str) {
        let since = Instant::now();
        while self.value(&format!("Boolean({expression})")) != true {
            if since.elapsed() > PATIENCE {
                let facts = self.value("window.shoal?.facts ?? document.body.innerText");
                panic!("{expression}: still not so after {PATIENCE:?}: {facts} {:?}", self.complaints);
            }
            std::thread::sleep(Duration::from_millis(50));
        }
    }

    /// Presses a key, such as `p` or `Escape`.
    pub fn press(&mut self, key: &str) {
        let text = if key.chars().count() == 1 { json!(key) } else { Value::Null };
        let mut event = json!({ "type": "keyDown", "key": key });
        if !text.is_null() {
            event["text"] = text;
        }
        self.call("Input.dispatchKeyEvent", event);
        self.call("Input.dispatchKeyEvent", json!({ "type": "keyUp", "key": key }));
    }

    /// Clicks at a place in pixels from the top left.
    pub fn click(&mut self, x: f64, y: f64) {
        for kind in ["mouseMoved", "mousePressed", "mouseReleased"] {
            let event =
                json!({ "type": kind, "x": x, "y": y, "button": "left", "clickCount": 1, "buttons": 1 });
            self.call("Input.dispatchMouseEvent", event);
        }
    }

    /// Types into whatever has the focus.
    pub fn write(&mut self, text: &str) {
        self.call("Input.insertText", json!({ "text": text }));
    }

    /// Takes a picture and keeps it as `target/view/NAME.png`. Returns where.
    ///
    /// # Panics
    /// When the browser or the disk refuses.
    pub fn picture(&mut self, name: &str) -> PathBuf {
        self.keep(&format!("{name}.png"), json!({ "format": "png" }))
    }

    /// As [`picture`](Self::picture), small enough for the documentation: `target/view/NAME.webp`.
    ///
    /// # Panics
    /// When the browser or the disk refuses.
    pub fn small_picture(&mut self, name: &str) -> PathBuf {
        self.keep(&format!("{name}.webp"), json!({ "format": "webp", "quality": 78 }))
    }

    /// What has gone wrong on the page so far: exceptions, and what its own policy refused.
    pub fn complaints(&self) -> &[String] {
        &self.complaints
    }

    fn keep(&mut self, name: &str, format: Value) -> PathBuf {
        let picture = self.call("Page.captureScreenshot", format);
        let folder = crate::executable::target_folder().join("view");
        std::fs::create_dir_all(&folder).expect("a folder for pictures can be made");
        let path = folder.join(name);
        let data = picture["data"].as_str().expect("a picture has data");
        std::fs::write(&path, base64(data)).expect("a picture can be written");
        path
    }

    fn call(&mut self, method: &str, parameters: Value) -> Value {
        self.asked += 1;
        let mut message = json!({ "id": self.asked, "method": method, "params": parameters });
        if !self.session.is_empty() {
            message["sessionId"] = json!(self.session);
        }
        self.socket.send(Message::text(message.to_string())).expect("Chromium listens");
        loop {
            let message =
                self.socket.read().unwrap_or_else(|error| panic!("{method}: Chromium is silent: {error}"));
            let Message::Text(text) = message else { continue };
            let mut told: Value = serde_json::from_str(&text).expect("Chromium speaks JSON");
            if told["id"] == self.asked {
                assert!(told.get("error").is_none(), "{method}: {told}");
                return told["result"].take();
            }
            match told["method"].as_str() {
                Some("Runtime.exceptionThrown") => self.complaints.push(told["params"].to_string()),
                Some("Log.entryAdded") if told["params"]["entry"]["level"] == "error" => {
                    self.complaints.push(told["params"]["entry"]["text"].to_string());
                }
                _ => {}
            }
        }
    }
}

impl Drop for Chromium {
    fn drop(&mut self) {
        // Its own processes end with it; by force if it does not listen.
        let close = json!({ "id": 0, "method": "Browser.close" });
        let _deaf = self.socket.send(Message::text(close.to_string()));
        for _ in 0..100 {
            if !matches!(self.browser.try_wait(), Ok(None)) {
                return;
            }
            std::thread::sleep(Duration::from_millis(50));
        }
        let _ended = self.browser.kill();
        let _reaped = self.browser.wait();
    }
}

/// The first Chromium in the path.
fn installed() -> Option<PathBuf> {
    let path = std::env::var_os("PATH")?;
    let folders: Vec<PathBuf> = std::env::split_paths(&path).collect();
    let all = NAMES.iter().flat_map(|name| folders.iter().map(move |folder| folder.join(name)));
    all.into_iter().find(|program| program.is_file())
}

/// RFC 4648, section 4.
fn base64(text: &str) -> Vec<u8> {
    let digit = |byte: u8| match byte {
        b'A'..=b'Z' => u32::from(byte - b'A'),
        b'a'..=b'z' => u32::from(byte - b'a') + 26,
        b'0'..=b'9' => u32::from(byte - b'0') + 52,
        b'+' => 62,
        _ => 63,
    };
    let digits: Vec<u8> = text.bytes().filter(|byte| *byte != b'=').collect();
    let word =
        |four: &[u8]| four.iter().fold(0, |word, byte| word << 6 | digit(*byte)) << (6 * (4 - four.len()));
    digits.chunks(4).flat_map(|four| word(four).to_be_bytes()[1..four.len()].to_vec()).collect()
}

#[cfg(test)]
mod tests {
    #[test]
    fn base64_is_that_of_the_standard() {
        assert_eq!(
            ["Zg==", "Zm8=", "Zm9v", "Zm9vYmFy"].map(super::base64),
            [&b"f"[..], b"fo", b"foo", b"foobar"]
        );
    }
}
