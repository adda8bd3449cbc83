//! Who joins and who carries what: the launcher's decisions, without any network.

use std::time::Duration;

use super::handshake::{Challenge, Handshake, Join, Proof, Welcome, other_version};
use super::token::{Prover, is_proof, proof};
use crate::message::AuvId;

/// What the launcher asks of hosts, and tells them.
#[derive(Clone, Debug)]
pub struct Terms {
    /// Name of the scenario.
    pub name: String,
    /// Hash of its text, such as `blake3:...`.
    pub scenario: String,
    /// All AUVs of the run, neighbours in the order due together.
    pub auvs: Vec<AuvId>,
    /// How many hosts the run begins with.
    pub hosts: usize,
    /// How many AUVs share a process on the hosts.
    pub auvs_per_process: u32,
    /// What hosts must know, if anything.
    pub token: Option<String>,
    /// A host that is silent for longer is lost.
    pub limit: Duration,
    /// How far apart wall clocks may be, where that matters.
    pub clock_limit: Option<Duration>,
}

/// Beyond this the wall clocks of hosts are told to be apart, in seconds.
pub(super) const CLOCK_WARNING_S: f64 = 1.0;

/// A host that is joining.
#[derive(Clone, Debug)]
pub(super) struct Candidate {
    pub(super) join: Join,
    pub(super) challenge: Challenge,
}

/// What to answer to a handshake.
#[derive(Debug, PartialEq)]
pub(super) enum Decision {
    /// Send this; it is no news.
    Answer(Handshake),
    /// It is refused, for this reason.
    Refuse(String),
    /// It is in.
    Admit(Welcome),
}

impl Terms {
    /// Judges who asks to join; `challenge` is a fresh one.
    pub(super) fn challenged(&self, join: &Join, challenge: &Challenge) -> Decision {
        if let Some(reason) = other_version(&join.program, join.messages) {
            return Decision::Refuse(reason);
        }
        if join.slots == 0 {
            return Decision::Refuse("it offers no slots: start it with --slots N".to_owned());
        }
        if let Some(only) = join.scenario.as_ref().filter(|only| **only != self.scenario) {
            return Decision::Refuse(format!(
                "it insists on a scenario with hash {only}, and this run of {} has {}: give both ends the same file, or leave \
                 --scenario out on the host",
                self.name, self.scenario
            ));
        }
        Decision::Answer(Handshake::Challenge(challenge.clone()))
    }

    /// Judges the answer to a challenge that arrived when the launcher's clock read `now_ns`.
    pub(super) fn proven(
        &self,
        Candidate { join, challenge }: &Candidate,
        answer: &Proof,
        now_ns: i64,
        run: &str,
        spare: bool,
    ) -> Decision {
        let proof_of_launcher = match (&self.token, &answer.proof) {
            (Some(token), Some(stated))
                if is_proof(stated, token, Prover::Host, &join.nonce, &challenge.nonce) =>
            {
                Some(proof(token, Prover::Launcher, &join.nonce, &challenge.nonce))
            }
            (Some(_), Some(_)) => {
                return Decision::Refuse("its token is another one than the launcher's".to_owned());
            }
            (Some(_), None) => {
                return Decision::Refuse(
                    "it shows no token, and the launcher asks for one: give it with --token FILE".to_owned(),
                );
            }
            (None, _) => None,
        };
        let half_ns = (now_ns - answer.challenged_ns) / 2;
        let clock_ahead_s = (answer.clock_ns - answer.challenged_ns - half_ns) as f64 * 1e-9;
        let clock_error_s = half_ns.max(0) as f64 * 1e-9;
        if let Some(limit) = self.clock_limit
            && clock_ahead_s.abs() - clock_error_s > limit.as_secs_f64()
        {
            return Decision::Refuse(format!(
                "its wall clock is {clock_ahead_s:+.3} s from the launcher's, and a paced run allows {} s: set the clocks, with NTP \
                 for example, or leave out --pace",
                limit.as_secs_f64()
            ));
        }
        Decision::Admit(Welcome {
            run: run.to_owned(),
            name: self.name.clone(),
            scenario: self.scenario.clone(),
            proof: proof_of_launcher,
            limit_s: self.limit.as_secs_f64(),
            clock_ahead_s,
            clock_error_s,
            spare,
        })
    }
}

/// Shares AUVs out to hosts of so many slots, neighbours by id together, in proportion; else how many slots are missing. In each
/// share they have the order of `auvs`.
pub(super) fn share_out(auvs: &[AuvId], slots: &[u32]) -> Result<Vec<Vec<AuvId>>, usize> {
    let offered: u64 = slots.iter().map(|&slots| u64::from(slots)).sum();
    let needed = auvs.len() as u64;
    if offered < needed {
        return Err((needed - offered) as usize);
    }
    let mut sorted = auvs.to_vec();
    sorted.sort_unstable();
    let (mut shares, mut offered_before) = (Vec::with_capacity(slots.len()), 0);
    for &slots in slots {
        // The floor of a growing fraction: no share is greater than its slots, and none is forgotten.
        let border = |offered_so_far: u64| (needed * offered_so_far / offered.max(1)) as usize;
        let after = offered_before + u64::from(slots);
        let share = sorted.get(border(offered_before)..border(after)).unwrap_or_default();
        shares.push(auvs.iter().copied().filter(|auv| share.binary_search(auv).is_ok()).collect());
        offered_before = after;
    }
    Ok(shares)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::codec::FORMAT;
    use crate::hosts::handshake::PROGRAM;

    fn terms() -> Terms {
        Terms {
            name: "six-circles".into(),
            scenario: "blake3:aa".into(),
            auvs: (0..6).map(AuvId).collect(),
            hosts: 2,
            auvs_per_process: 1,
            token: None,
            limit: Duration::from_secs(30),
            clock_limit: None,
        }
    }

    fn join() -> Join {
        Join {
            host: "01".into(),
            name: "alpha".into(),
            program: PROGRAM.into(),
            messages: FORMAT,
            slots: 3,
            nonce: "02".into(),
            scenario: None,
            process: None,
        }
    }

    fn challenge() -> Challenge {
        Challenge { nonce: "03".into(), token: false, clock_ns: 1_000_000_000 }
    }

    fn refused(decision: Decision, part: &str) {
        assert!(
            matches!(&decision, Decision::Refuse(reason) if reason.contains(part)),
            "{part}: {decision:?}"
        );
    }

    #[test]
    fn who_does_not_fit_is_refused_with_a_reason() {
        let asked = |join: Join| terms().challenged(&join, &challenge());
        assert_eq!(asked(join()), Decision::Answer(Handshake::Challenge(challenge())));
        refused(asked(Join { program: "0.0.0".into(), ..join() }), "use the same build");
        refused(asked(Join { messages: 0, ..join() }), "format 0");
        refused(asked(Join { slots: 0, ..join() }), "--slots");
        refused(asked(Join { scenario: Some("blake3:bb".into()), ..join() }), "insists on a scenario");
        let same = Join { scenario: Some("blake3:aa".into()), ..join() };
        assert!(matches!(asked(same), Decision::Answer(_)));
    }

    #[test]
    fn tokens_and_clocks_are_judged() {
        let candidate = Candidate { join: join(), challenge: challenge() };
        let answer =
            Proof { host: "01".into(), proof: None, challenged_ns: 1_000_000_000, clock_ns: 4_000_000_000 };
        // The round trip took 2 s: the host read its clock when the launcher's stood at 2 s, give or take one.
        let judge =
            |terms: &Terms, answer: &Proof| terms.proven(&candidate, answer, 3_000_000_000, "run", false);
        let Decision::Admit(welcome) = judge(&terms(), &answer) else { panic!("it is admitted") };
        assert_eq!((welcome.clock_ahead_s, welcome.clock_error_s, welcome.proof), (2.0, 1.0, None));
        let strict = Terms { clock_limit: Some(Duration::from_millis(500)), ..terms() };
        refused(judge(&strict, &answer), "+2.000 s");
        let lenient = Terms { clock_limit: Some(Duration::from_millis(1500)), ..terms() };
        assert!(matches!(judge(&lenient, &answer), Decision::Admit(_)));

        let secret = Terms { token: Some("sesame".into()), ..terms() };
        refused(judge(&secret, &answer), "shows no token");
        let told =
            |token: &str| Proof { proof: Some(proof(token, Prover::Host, "02", "03")), ..answer.clone() };
        refused(judge(&secret, &told("barley")), "another one");
        let Decision::Admit(welcome) = judge(&secret, &told("sesame")) else { panic!("it is admitted") };
        assert!(is_proof(&welcome.proof.unwrap(), "sesame", Prover::Launcher, "02", "03"));
    }

    #[test]
    fn shares_are_in_proportion() {
        let auvs: Vec<AuvId> = (0..10).map(AuvId).collect();
        let of = |slots: &[u32]| {
            share_out(&auvs, slots).map(|shares| shares.iter().map(Vec::len).collect::<Vec<_>>())
        };
        assert_eq!(of(&[10]), Ok(vec![10]));
        assert_eq!(of(&[10, 30]), Ok(vec![2, 8]));
        assert_eq!(of(&[5, 5]), Ok(vec![5, 5]));
        assert_eq!(of(&[5, 2]), Err(3));
        assert_eq!(of(&[]), Err(10));
    }

    proptest! {
        #[test]
        fn nobody_carries_too_much_and_nobody_is_forgotten(
            count in 0_u32..500,
            slots in prop::collection::vec(0_u32..200, 1..8),
        ) {
            let auvs: Vec<AuvId> = (0..count).rev().map(AuvId).collect();
            match share_out(&auvs, &slots) {
                Ok(shares) => {
                    prop_assert!(shares.iter().zip(&slots).all(|(share, &slots)| share.len() <= slots as usize));
                    prop_assert!(shares.iter().all(|share| share.is_sorted_by(|one, next| one > next)));
                    let mut all = shares.concat();
                    all.sort_unstable_by(|one, next| next.cmp(one));
                    prop_assert_eq!(all, auvs);
                }
                Err(missing) => {
                    let offered = slots.iter().sum::<u32>() as usize;
                    prop_assert_eq!(missing, auvs.len() - offered);
                }
            }
        }
    }
}
