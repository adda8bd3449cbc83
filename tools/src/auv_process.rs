//! `shoal auv`: a process of AUVs, usually one. It gets a link to the channel and their ids, and nothing else.

use shoal_auv::Auv;
use shoal_bus::lockstep::{Link, LinkError, live};
use shoal_bus::message::AuvId;
use shoal_bus::os;
use shoal_bus::run_dir::RunDir;
use shoal_bus::shared_memory::SharedMemoryLink;
use shoal_bus::zenoh::{ZenohFleet, ZenohLink};

use crate::cli::{AuvArgs, Bus};
use crate::exit::Exit;
use crate::failure::{Failure, While};
use crate::seat;

/// Lives the lives of its AUVs.
pub fn run(args: &AuvArgs) -> Result<Exit, Failure> {
    if !os::end_with_parent(args.launcher).while_doing("tie this AUV's life to the run's")? {
        return Ok(Exit::Failed);
    }
    let auvs: Vec<AuvId> = args.auvs.clone().map(AuvId).collect();
    // All AUVs of a run share one log, in which the launcher looks for the last words of those that it lost.
    let name = seat::name(&args.auvs);
    std::panic::set_hook(Box::new(move |panic| {
        eprintln!("{name}: {}", panic.to_string().replace('\n', ": "));
    }));
    let run = RunDir::open(&args.run).while_doing("open the run's folder")?;
    let joined: Result<Box<dyn Link>, LinkError> = match args.bus {
        Bus::Local => return Err(Failure::usage("the local bus has no AUV processes")),
        Bus::Iceoryx2 => SharedMemoryLink::join(&run, &auvs).map(|link| Box::new(link) as Box<dyn Link>),
        Bus::Zenoh => {
            let endpoint = args.endpoint.clone().unwrap_or_else(|| ZenohFleet::local_endpoint(&run));
            ZenohLink::join(&endpoint, run.id(), &auvs).map(|link| Box::new(link) as Box<dyn Link>)
        }
    };
    let mut link = joined.map_err(|error| named(args, &error))?;
    live(link.as_mut(), Auv::new).map_err(|error| named(args, &error))?;
    Ok(Exit::Good)
}

/// The error with the name of who had it, for the common log.
fn named(args: &AuvArgs, error: &LinkError) -> Failure {
    Failure { exit: Exit::Failed, message: format!("{}: {error}", seat::name(&args.auvs)) }
}
