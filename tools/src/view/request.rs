//! Who may see the page: whoever knows the token, from a page of this server's own.
//!
//! Any program of any user of this machine can reach the port, and any web page that the user's browser shows can ask for
//! it, under a name that it resolves to this machine as well. So the path begins with a secret, `Host` must be a
//! name of this machine, and a web socket must be opened by a page that came from here.

use std::fs::File;
use std::io::{self, Read};

use tungstenite::handshake::server::Request;
use tungstenite::http::HeaderMap;

/// What is asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wanted {
    /// The page.
    Page,
    /// Its program.
    Script,
    /// Its looks.
    Style,
    /// The licences of what is built into it.
    Licences,
    /// The web socket.
    Socket,
}

/// Why nothing is given.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Refused {
    /// It comes under another machine's name, or from another's page.
    Foreign,
    /// There is nothing, or the secret is wrong.
    NotFound,
}

/// What `request` asks for, if it may.
pub fn wanted(request: &Request, token: &str) -> Result<Wanted, Refused> {
    let headers = request.headers();
    let host = header(headers, "host").unwrap_or_default();
    if !is_this_machine(host) {
        return Err(Refused::Foreign);
    }
    let path = request.uri().path();
    let page = path.strip_prefix('/').and_then(|path| path.split_once('/'));
    let (given, file) = page.ok_or(Refused::NotFound)?;
    if !same(given, token) {
        return Err(Refused::NotFound);
    }
    match file {
        "" => Ok(Wanted::Page),
        "view.js" => Ok(Wanted::Script),
        "view.css" => Ok(Wanted::Style),
        "LICENSES.txt" => Ok(Wanted::Licences),
        // Browsers always tell where the page that opens a web socket came from.
        "socket" if header(headers, "origin") == Some(&format!("http://{host}")) => Ok(Wanted::Socket),
        "socket" => Err(Refused::Foreign),
        _ => Err(Refused::NotFound),
    }
}

/// A new secret: 128 bits, two hexadecimal digits a byte.
///
/// # Errors
/// When the system has no random numbers.
pub fn token() -> io::Result<String> {
    let mut bytes = [0; 16];
    File::open("/dev/urandom")?.read_exact(&mut bytes)?;
    Ok(bytes.iter().map(|byte| format!("{byte:02x}")).collect())
}

/// A name of this machine for itself, with any port: a tunnel may end at another one.
fn is_this_machine(host: &str) -> bool {
    let name = match host.rsplit_once(':') {
        Some((name, port)) if port.parse::<u16>().is_ok() => name,
        _ => host,
    };
    matches!(name, "127.0.0.1" | "localhost" | "[::1]")
}

/// Compares in a time that does not tell how much is right.
fn same(given: &str, token: &str) -> bool {
    let differ = given.bytes().zip(token.bytes()).fold(0, |differ, (one, other)| differ | (one ^ other));
    given.len() == token.len() && differ == 0
}

fn header<'a>(headers: &'a HeaderMap, name: &str) -> Option<&'a str> {
    headers.get(name)?.to_str().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    const TOKEN: &str = "00112233445566778899aabbccddeeff";

    fn asked(path: &str, headers: &[(&str, &str)]) -> Result<Wanted, Refused> {
        let mut request = Request::builder().uri(path);
        for (name, value) in headers {
            request = request.header(*name, *value);
        }
        wanted(&request.body(()).unwrap(), TOKEN)
    }

    #[test]
    fn the_page_is_for_those_who_know_the_token() {
        let host = [("host", "127.0.0.1:8123")];
        let path = |file: &str| format!("/{TOKEN}/{file}");
        assert_eq!(asked(&path(""), &host), Ok(Wanted::Page));
        assert_eq!(asked(&path("view.js"), &[("host", "localhost:9")]), Ok(Wanted::Script));
        for path in
            ["/", "/view.js", "//view.js", "/00112233445566778899aabbccddeef0/", "/0/", &path("../secret")]
        {
            assert_eq!(asked(path, &host), Err(Refused::NotFound), "{path}");
        }
    }

    #[test]
    fn another_name_for_this_machine_is_refused() {
        let path = format!("/{TOKEN}/");
        for host in ["evil.example:8123", "127.0.0.1.evil.example", "", "localhost.", "127.0.0.1:8123:1"] {
            assert_eq!(asked(&path, &[("host", host)]), Err(Refused::Foreign), "{host}");
        }
    }

    #[test]
    fn only_pages_from_here_open_the_socket() {
        let path = format!("/{TOKEN}/socket");
        let host = ("host", "127.0.0.1:8123");
        assert_eq!(asked(&path, &[host, ("origin", "http://127.0.0.1:8123")]), Ok(Wanted::Socket));
        for origin in ["http://evil.example", "http://127.0.0.1:1", "null"] {
            assert_eq!(asked(&path, &[host, ("origin", origin)]), Err(Refused::Foreign));
        }
        assert_eq!(asked(&path, &[host]), Err(Refused::Foreign));
    }

    #[test]
    fn no_two_tokens_are_the_same() {
        let (one, other) = (token().unwrap(), token().unwrap());
        assert_eq!((one.len(), other.len()), (32, 32));
        assert_ne!(one, other);
    }
}
