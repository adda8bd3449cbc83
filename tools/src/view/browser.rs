//! How to get to see the page: a browser on this machine, or a tunnel from the machine where the user sits.

use std::env;
use std::process::{Command, Stdio};

/// Opens `url` in the desktop's browser; whether there is one.
pub fn open(url: &str) -> bool {
    if env::var_os("DISPLAY").is_none() && env::var_os("WAYLAND_DISPLAY").is_none() {
        return false;
    }
    let quiet = || Stdio::null();
    Command::new("xdg-open").arg(url).stdin(quiet()).stdout(quiet()).stderr(quiet()).spawn().is_ok()
}

/// In a remote shell, the command that makes `port` of this machine one of the machine that the shell was opened from.
pub fn tunnel(port: u16) -> Option<String> {
    let connection = env::var("SSH_CONNECTION").ok()?;
    Some(tunnel_to(&connection, env::var("USER").ok().as_deref(), port))
}

/// `connection` as sshd sets it: addresses and ports of the client, then of this machine.
fn tunnel_to(connection: &str, user: Option<&str>, port: u16) -> String {
    let here = connection.split(' ').nth(2).filter(|address| !address.is_empty()).unwrap_or("HOST");
    let user = user.map_or(String::new(), |user| format!("{user}@"));
    format!("ssh -L {port}:127.0.0.1:{port} {user}{here}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_tunnel_names_this_machine_as_the_shell_reached_it() {
        let line = tunnel_to("192.0.2.7 53122 192.0.2.20 22", Some("ada"), 8123);
        assert_eq!(line, "ssh -L 8123:127.0.0.1:8123 ada@192.0.2.20");
        assert_eq!(tunnel_to("", None, 1), "ssh -L 1:127.0.0.1:1 HOST");
    }
}
