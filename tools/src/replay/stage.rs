//! The live AUVs of a replay.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use shoal_auv::Auv;
use shoal_bus::local::Local;
use shoal_bus::lockstep::{Answers, Batch, Fleet, FleetError};
use shoal_bus::message::{AuvId, Born, Sensed};
use shoal_bus::run_dir::RunDir;
use shoal_bus::shared_memory::SharedMemoryFleet;

use super::{Carrier, ReplayArgs};
use crate::cli::Bus;
use crate::failure::{Failure, While};
use crate::limits;
use crate::processes::{FAREWELL, Swarm};
use crate::run::Residue;
use crate::seat::Seat;

/// AUVs that have been born.
pub struct Stage {
    fleet: Box<dyn Fleet>,
    // In this order: the processes end before their folder goes.
    swarm: Option<Swarm>,
    _residue: Option<Residue>,
    over: Arc<AtomicBool>,
}

impl Stage {
    /// Starts them and tells them what they are.
    pub fn open(
        args: &ReplayArgs,
        description: &serde_json::Value,
        born: &[Born],
        interrupted: &Arc<AtomicBool>,
    ) -> Result<Self, Failure> {
        let mut stage = match args.bus {
            Carrier::Local => Self {
                fleet: Box::new(Local::on_all_cores(Auv::new)),
                swarm: None,
                _residue: None,
                over: Arc::default(),
            },
            Carrier::Iceoryx2 => Self::of_processes(args, description, born, interrupted)?,
        };
        let stillborn = stage.fleet.born(born).map_err(Failure::failed)?;
        match stillborn.first() {
            None => Ok(stage),
            Some(loss) => {
                Err(Failure::failed(format!("AUV {} could not be born: {}", loss.auv, loss.reason)))
            }
        }
    }

    fn of_processes(
        args: &ReplayArgs,
        description: &serde_json::Value,
        born: &[Born],
        interrupted: &Arc<AtomicBool>,
    ) -> Result<Self, Failure> {
        let auvs: Vec<AuvId> = born.iter().map(|born| born.auv).collect();
        let seats = Seat::of(&auvs, args.auvs_per_process.get());
        limits::check(seats.len(), Bus::Iceoryx2)?;
        RunDir::sweep();
        let run = RunDir::create(description).while_doing("make a folder for the replay")?;
        let residue = Residue(run.clone());
        let processes: Vec<Vec<AuvId>> = seats.iter().map(Seat::ids).collect();
        let mut fleet = SharedMemoryFleet::create(&run, &processes).map_err(Failure::failed)?;
        let mut swarm = Swarm::default();
        swarm.start_in_memory(&run, seats)?;
        fleet.attach_processes(&swarm.processes()).map_err(Failure::failed)?;
        let over = Arc::new(AtomicBool::new(false));
        let (handle, interrupted, is_over) =
            (fleet.interrupt_handle(), Arc::clone(interrupted), Arc::clone(&over));
        let watch = move || {
            while !is_over.load(Ordering::Acquire) {
                if interrupted.load(Ordering::Acquire) {
                    return handle.interrupt();
                }
                std::thread::sleep(Duration::from_millis(20));
            }
        };
        std::thread::Builder::new()
            .name("interrupts".to_owned())
            .spawn(watch)
            .while_doing("start a thread")?;
        Ok(Self { fleet: Box::new(fleet), swarm: Some(swarm), _residue: Some(residue), over })
    }

    /// Tells them what was told, and brings back what they answer; `None` when interrupted.
    pub fn tell(&mut self, sensed: &[Batch<Sensed>]) -> Result<Option<Answers>, Failure> {
        match self.fleet.exchange(sensed, &mut || {}) {
            Ok(mut answers) => {
                for loss in &mut answers.losses {
                    if let Some(ending) = self.swarm.as_mut().and_then(|swarm| swarm.ending_of(loss.auv)) {
                        loss.reason = ending.reason;
                    }
                }
                Ok(Some(answers))
            }
            Err(FleetError::Interrupted) => Ok(None),
            Err(error) => Err(Failure::failed(error)),
        }
    }

    /// Tells them that it is over, and waits for their end.
    pub fn close(&mut self) {
        self.over.store(true, Ordering::Release);
        self.fleet.end();
        if let Some(swarm) = &mut self.swarm {
            swarm.wait(FAREWELL);
        }
    }
}
