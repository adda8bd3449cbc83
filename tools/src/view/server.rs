//! The page and its web socket, on one port that this machine alone can reach.

use std::io::{self, Read, Write};
use std::net::{Ipv4Addr, TcpListener, TcpStream};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;
use std::time::Duration;

use tungstenite::WebSocket;
use tungstenite::handshake::machine::TryParse;
use tungstenite::handshake::server::{Request, create_response, write_response};
use tungstenite::protocol::{Role, WebSocketConfig};

use super::cast::Cast;
use super::request::{Refused, Wanted, token, wanted};
use super::session;
use super::store::Store;

/// The page.
pub const PAGE: &str = include_str!("../../view/src/index.html");
/// Its program, as `npm run build` in `tools/view` leaves it.
pub const SCRIPT: &str = include_str!("../../view/dist/view.js");
/// Its looks.
pub const STYLE: &str = include_str!("../../view/src/view.css");
/// The licences of what is built into it.
pub const LICENCES: &str = include_str!("../../view/dist/LICENSES.txt");

/// Bytes that a request may have.
const HEAD_LIMIT_BYTES: usize = 16 << 10;

/// A browser that says nothing for so long has lost interest.
const PATIENCE: Duration = Duration::from_secs(10);

/// Connections at a time: each page has one, and some more while it loads.
const CONNECTIONS_MAX: usize = 64;

/// Bytes that a page may say at a time.
const MESSAGE_LIMIT_BYTES: usize = 4 << 10;

/// Nothing from elsewhere: what a record says cannot become a program.
const POLICY: &str = "default-src 'none'; script-src 'self'; style-src 'self'; connect-src 'self'; img-src data:; \
                      base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

/// A port of this machine, and the secret that its address needs.
pub struct Server {
    listener: TcpListener,
    port: u16,
    token: String,
}

/// What every connection needs.
struct Shared {
    token: String,
    cast: Arc<Cast>,
    store: Arc<Store>,
    connections: AtomicUsize,
}

impl Server {
    /// Takes `port`, or a free one when it is 0.
    ///
    /// # Errors
    /// When the port is taken, or not for this user.
    pub fn bind(port: u16) -> io::Result<Self> {
        let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, port))?;
        Ok(Self { port: listener.local_addr()?.port(), listener, token: token()? })
    }

    /// The port.
    pub fn port(&self) -> u16 {
        self.port
    }

    /// The address of the page.
    pub fn url(&self) -> String {
        format!("http://127.0.0.1:{}/{}/", self.port, self.token)
    }

    /// Serves, in threads of its own, as long as the process lives.
    ///
    /// # Errors
    /// When there is no thread to be had.
    pub fn serve(self, cast: Arc<Cast>, store: Arc<Store>) -> io::Result<()> {
        let Self { listener, token, .. } = self;
        let shared = Arc::new(Shared { token, cast, store, connections: AtomicUsize::new(0) });
        thread::Builder::new().name("listener".to_owned()).spawn(move || {
            for stream in listener.incoming() {
                // One that failed before it began, or out of descriptors: the next one may do.
                let Ok(stream) = stream else {
                    thread::sleep(Duration::from_millis(10));
                    continue;
                };
                let shared = Arc::clone(&shared);
                if shared.connections.fetch_add(1, Ordering::Relaxed) >= CONNECTIONS_MAX {
                    shared.connections.fetch_sub(1, Ordering::Relaxed);
                    continue;
                }
                let begun = thread::Builder::new().name("page".to_owned()).spawn(move || {
                    // A browser that goes away in between is no error.
                    let _gone = connection(stream, &shared);
                    shared.connections.fetch_sub(1, Ordering::Relaxed);
                });
                drop(begun);
            }
        })?;
        Ok(())
    }
}

/// One request, and what it leads to.
fn connection(mut stream: TcpStream, shared: &Shared) -> io::Result<()> {
    stream.set_nodelay(true)?;
    stream.set_read_timeout(Some(PATIENCE))?;
    stream.set_write_timeout(Some(PATIENCE))?;
    let Some((request, rest)) = request(&mut stream)? else {
        return answer(&mut stream, "400 Bad Request", "text/plain", "this is no request for a page\n");
    };
    let html = "text/html; charset=utf-8";
    match wanted(&request, &shared.token) {
        Ok(Wanted::Page) => answer(&mut stream, "200 OK", html, PAGE),
        Ok(Wanted::Script) => answer(&mut stream, "200 OK", "text/javascript; charset=utf-8", SCRIPT),
        Ok(Wanted::Style) => answer(&mut stream, "200 OK", "text/css; charset=utf-8", STYLE),
        Ok(Wanted::Licences) => answer(&mut stream, "200 OK", "text/plain; charset=utf-8", LICENCES),
        Ok(Wanted::Socket) => match create_response(&request) {
            Ok(response) => {
                write_response(&mut stream, &response).map_err(io::Error::other)?;
                let config = WebSocketConfig::default()
                    .max_message_size(Some(MESSAGE_LIMIT_BYTES))
                    .max_frame_size(Some(MESSAGE_LIMIT_BYTES));
                let socket = WebSocket::from_partially_read(stream, rest, Role::Server, Some(config));
                session::hold(socket, &shared.cast, &shared.store).map_err(io::Error::other)
            }
            Err(error) => answer(&mut stream, "400 Bad Request", "text/plain", &format!("{error}\n")),
        },
        Err(Refused::Foreign) => {
            answer(&mut stream, "403 Forbidden", "text/plain", "only for pages of this machine\n")
        }
        Err(Refused::NotFound) => answer(
            &mut stream,
            "404 Not Found",
            "text/plain",
            "use the whole address that `shoal view` printed\n",
        ),
    }
}

/// The request, and what came behind it; `None` for something else.
fn request(stream: &mut TcpStream) -> io::Result<Option<(Request, Vec<u8>)>> {
    let mut bytes = Vec::new();
    let mut piece = [0; 2048];
    while bytes.len() < HEAD_LIMIT_BYTES {
        let length = stream.read(&mut piece)?;
        if length == 0 {
            return Ok(None);
        }
        bytes.extend(piece.iter().take(length));
        match Request::try_parse(&bytes) {
            Ok(None) => {}
            Ok(Some((length, request))) => return Ok(Some((request, bytes.split_off(length)))),
            Err(_) => return Ok(None),
        }
    }
    Ok(None)
}

fn answer(stream: &mut TcpStream, status: &str, kind: &str, body: &str) -> io::Result<()> {
    write!(
        stream,
        "HTTP/1.1 {status}\r\nContent-Type: {kind}\r\nContent-Length: {}\r\nContent-Security-Policy: {POLICY}\r\n\
         X-Content-Type-Options: nosniff\r\nReferrer-Policy: no-referrer\r\nCache-Control: no-store\r\n\
         Connection: close\r\n\r\n{body}",
        body.len()
    )?;
    stream.flush()
}
