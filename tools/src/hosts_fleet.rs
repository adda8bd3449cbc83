//! The hosts that carry AUVs of a run, as its command line asks for them.

use std::time::Duration;

use shoal_bus::hosts::{HostsFleet, Network, Terms, scenario_hash};
use shoal_bus::message::AuvId;
use shoal_scenario::Scenario;

use crate::cli::{Pace, RunArgs};
use crate::failure::Failure;
use crate::host::token;
use crate::launch::{HostsOrder, Order};

/// How far the wall clocks of hosts may be apart in a paced run.
const CLOCK_LIMIT: Duration = Duration::from_secs(1);

impl HostsOrder {
    /// What the command line asks for.
    pub fn read(args: &RunArgs) -> Result<Option<Self>, Failure> {
        let (Some(listen), Some(count)) = (&args.listen, args.hosts) else {
            return match &args.network.zenoh_config {
                Some(_) => {
                    Err(Failure::usage("--zenoh-config is for runs on hosts: add --listen and --hosts"))
                }
                None => Ok(None),
            };
        };
        // The channel reads it again; what is wrong with it is told before anything is started.
        Network::new(args.network.zenoh_config.as_deref()).map_err(Failure::usage)?;
        Ok(Some(Self {
            listen: listen.clone(),
            count: count.get() as usize,
            zenoh_config: args.network.zenoh_config.clone(),
            token: token(args.network.token.as_deref())?,
            limit_s: args.host_limit,
        }))
    }

    /// Listens for hosts for these AUVs, neighbours in the order due together.
    pub fn listen(
        &self,
        order: &Order,
        scenario: &Scenario,
        auvs: Vec<AuvId>,
        mut tell: impl FnMut(&str) + Copy + 'static,
    ) -> Result<HostsFleet, Failure> {
        let terms = Terms {
            name: scenario.name.clone(),
            scenario: scenario_hash(&order.text),
            auvs,
            hosts: self.count,
            auvs_per_process: order.auvs_per_process.get(),
            token: self.token.clone(),
            limit: Duration::from_secs_f64(self.limit_s),
            clock_limit: (order.pace != Pace::Max).then_some(CLOCK_LIMIT),
        };
        let network = Network::new(self.zenoh_config.as_deref()).map_err(Failure::usage)?;
        let (listen, count) = (&self.listen, self.count);
        let hosts = if count == 1 { "1 host".to_owned() } else { format!("{count} hosts") };
        let waiting =
            format!("waiting for {hosts} on {listen}: start `shoal host --connect {listen} --slots N` there");
        let fleet = HostsFleet::listen(listen, &network, terms, tell).map_err(Failure::failed)?;
        tell(&waiting);
        Ok(fleet)
    }
}
