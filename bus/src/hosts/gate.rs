//! The launcher's door: who knocks is challenged, admitted or refused.

use std::sync::{Arc, PoisonError};

use super::fleet::HostsFleet;
use super::frame::Line;
use super::handshake::{Challenge, Handshake, Join, Proof, Welcome, this_machine, wall_clock_ns};
use super::heart::{Pulse, send};
use super::member::{Awaits, Member, State};
use super::roster::{CLOCK_WARNING_S, Candidate, Decision};
use super::token::random_hex;
use super::{down_key, reply_key};
use crate::os::Process;

/// So many may be joining at once: what strangers can make a launcher remember.
const CANDIDATES_MAX: usize = 1000;

impl HostsFleet {
    /// Answers a handshake.
    pub(super) fn shake_hands(&mut self, bytes: &[u8]) {
        match Handshake::read(bytes) {
            Ok(Handshake::Join(join)) => self.asked(join),
            Ok(Handshake::Proof(proof)) => self.proven(&proof),
            // Not for a launcher.
            Ok(Handshake::Challenge(_) | Handshake::Welcome(_) | Handshake::Refusal { .. }) => {}
            Err(stranger) => {
                let reason = stranger.reason();
                match &stranger.host {
                    Some(host) => self.refuse(host, host, reason),
                    None => self.tell(&format!("somebody who is no host knocked: {reason}")),
                }
            }
        }
    }

    fn asked(&mut self, join: Join) {
        if !is_plain(&join.host) {
            return self.tell("somebody who is no host knocked: its id is none");
        }
        if let Some(welcome) = self.welcomed(&join.host) {
            return self.answer(&join.host, &Handshake::Welcome(welcome));
        }
        let Ok(nonce) = random_hex(16) else {
            return self.refuse(&join.host, &join.name, "the launcher has no random numbers".to_owned());
        };
        let challenge = Challenge { nonce, token: self.terms.token.is_some(), clock_ns: wall_clock_ns() };
        match self.terms.challenged(&join, &challenge) {
            Decision::Answer(answer) => {
                let host = join.host.clone();
                self.candidates.retain(|candidate| candidate.join.host != host);
                if self.candidates.len() >= CANDIDATES_MAX {
                    // Who is still there asks again.
                    self.candidates.remove(0);
                }
                self.candidates.push(Candidate { join, challenge });
                self.answer(&host, &answer);
            }
            Decision::Refuse(reason) => self.refuse(&join.host, &join.name, reason),
            // Nobody is admitted without a proof.
            Decision::Admit(_) => {}
        }
    }

    fn proven(&mut self, proof: &Proof) {
        let found = self.candidates.iter().position(|candidate| candidate.join.host == proof.host);
        let Some(candidate) = found.map(|at| self.candidates.swap_remove(at)) else {
            if let Some(welcome) = self.welcomed(&proof.host) {
                self.answer(&proof.host, &Handshake::Welcome(welcome));
            }
            return;
        };
        let decision = self.terms.proven(&candidate, proof, wall_clock_ns(), &self.run, self.has_begun);
        match decision {
            Decision::Admit(welcome) => self.admit(candidate.join, welcome),
            Decision::Refuse(reason) => self.refuse(&candidate.join.host, &candidate.join.name, reason),
            Decision::Answer(answer) => self.answer(&candidate.join.host, &answer),
        }
    }

    fn welcomed(&self, host: &str) -> Option<Welcome> {
        let member = self.members.iter().find(|member| member.join.host == host)?;
        (member.state != State::Gone).then(|| member.welcome.clone())
    }

    fn admit(&mut self, join: Join, welcome: Welcome) {
        let is_here = |name: &&super::handshake::ProcessName| Some(&name.machine) == this_machine().as_ref();
        let process = join.process.as_ref().filter(is_here);
        // One that has ended by now is noticed by its silence.
        let process = process.and_then(|name| Process::open(name.pid).ok().flatten());
        let pulse = Arc::new(Pulse::new(&join.host, down_key(&self.run, &join.host), process));
        self.pulses.lock().unwrap_or_else(PoisonError::into_inner).push(Arc::clone(&pulse));
        let name = self.free_name(&join.name);
        let (host, slots) = (join.host.clone(), join.slots);
        let Welcome { clock_ahead_s, clock_error_s, .. } = welcome;
        self.answer(&host, &Handshake::Welcome(welcome.clone()));
        self.members.push(Member {
            join,
            name: name.clone(),
            welcome,
            pulse,
            line: Line::default(),
            state: State::Idle,
            awaits: Awaits::Nothing,
            auvs: Default::default(),
        });
        let role = if self.has_begun { ", as a spare" } else { "" };
        self.tell(&format!("host {name} joined with {slots} slots{role}"));
        if clock_ahead_s.abs() - clock_error_s > CLOCK_WARNING_S {
            self.tell(&format!(
                "the wall clock of host {name} is {clock_ahead_s:+.3} s from this one (give or take {clock_error_s:.3} s); in lockstep \
                 that changes nothing"
            ));
        }
    }

    /// The name, with a number if it is taken.
    fn free_name(&self, name: &str) -> String {
        let is_taken = |name: &str| self.members.iter().any(|member| member.name == name);
        let numbered = (2..).map(|number| format!("{name}-{number}"));
        std::iter::once(name.to_owned()).chain(numbered).find(|name| !is_taken(name)).unwrap_or_default()
    }

    fn refuse(&mut self, host: &str, name: &str, reason: String) {
        self.tell(&format!("host {name} was refused: {reason}"));
        if is_plain(host) {
            self.answer(host, &Handshake::Refusal { reason });
        }
    }

    fn answer(&self, host: &str, answer: &Handshake) {
        // Who gets no answer asks again.
        let _lost = send(&self.session, &reply_key(host), answer.write().into());
    }
}

impl Member {
    /// Its name and its slots, for people.
    pub(super) fn offer(&self) -> String {
        format!("{}: {}", self.name, self.join.slots)
    }
}

/// Whether it can be part of a key.
fn is_plain(id: &str) -> bool {
    (1..=32).contains(&id.len()) && id.bytes().all(|byte| byte.is_ascii_hexdigit())
}
