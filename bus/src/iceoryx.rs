//! iceoryx2 as this project uses it: each run an island of its own, nothing taken from the user's configuration.

use std::time::Duration;

use iceoryx2::port::publisher::Publisher;
use iceoryx2::port::subscriber::Subscriber;
use iceoryx2::prelude::{
    AllocationStrategy, BackpressureStrategy, Config, FileName, LogLevel, Node, NodeBuilder, Path,
    SemanticString, ServiceName, SignalHandlingMode, ipc, set_log_level,
};
use iceoryx2::service::port_factory::publish_subscribe::PortFactory;

use crate::run_dir::RunDir;

pub(crate) type Bytes = PortFactory<ipc::Service, [u8], ()>;
pub(crate) type BytesPublisher = Publisher<ipc::Service, [u8], ()>;
pub(crate) type BytesSubscriber = Subscriber<ipc::Service, [u8], ()>;

/// What iceoryx2 said, as text.
pub(crate) type Cause = String;

/// Who will ever use a service: iceoryx2 refuses or loses what exceeds it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Limits {
    pub(crate) publishers: usize,
    pub(crate) subscribers: usize,
    pub(crate) buffer: usize,
    /// Whether the oldest sample gives way when a buffer is full; else the newest is not delivered.
    pub(crate) overflow: bool,
}

/// This process's node on the island of `run`.
pub(crate) fn node(run: &RunDir) -> Result<Node<ipc::Service>, Cause> {
    set_log_level(LogLevel::Error);
    NodeBuilder::new()
        .config(&config(run)?)
        .signal_handling_mode(SignalHandlingMode::Disabled)
        .create::<ipc::Service>()
        .map_err(|error| format!("no node: {error}"))
}

fn config(run: &RunDir) -> Result<Config, Cause> {
    let (folder, prefix) = (run.path().join("tap"), format!("{}tap_", run.prefix()));
    let root = folder.to_str().and_then(|root| Path::new(root.as_bytes()).ok());
    let root = root.ok_or_else(|| format!("{} cannot be its root path", folder.display()))?;
    let mut config = Config::default();
    config.global.set_root_path(&root);
    config.global.prefix = FileName::new(prefix.as_bytes()).map_err(|error| format!("prefix: {error:?}"))?;
    // Observers come, and are killed, as they like: the dead would take the places of the living.
    config.global.node.cleanup_dead_nodes_on_creation = true;
    config.global.node.cleanup_dead_nodes_on_destruction = false;
    config.global.service.cleanup_dead_nodes_on_open = false;
    // On a machine where a thousand processes start, one waits for another longer than the usual second.
    config.global.creation_timeout = Duration::from_secs(30);
    Ok(config)
}

/// Creates the service `name`, sized by `limits`.
pub(crate) fn create(node: &Node<ipc::Service>, name: &str, limits: Limits) -> Result<Bytes, Cause> {
    node.service_builder(&service_name(name)?)
        .publish_subscribe::<[u8]>()
        .max_publishers(limits.publishers)
        .max_subscribers(limits.subscribers)
        .max_nodes(limits.publishers + limits.subscribers)
        .subscriber_max_buffer_size(limits.buffer)
        .subscriber_max_borrowed_samples(1)
        .history_size(0)
        .enable_safe_overflow(limits.overflow)
        .create()
        .map_err(|error| format!("service {name}: {error}"))
}

/// Opens the service `name` that another process created.
pub(crate) fn open(node: &Node<ipc::Service>, name: &str) -> Result<Bytes, Cause> {
    let builder = node.service_builder(&service_name(name)?).publish_subscribe::<[u8]>();
    builder.open().map_err(|error| format!("service {name}: {error}"))
}

fn service_name(name: &str) -> Result<ServiceName, Cause> {
    ServiceName::new(name).map_err(|error| format!("service name {name}: {error}"))
}

/// A publisher that never waits for a subscriber. Its samples are usually as long as `expected`; memory grows by itself.
pub(crate) fn publisher(service: &Bytes, expected: usize) -> Result<BytesPublisher, Cause> {
    service
        .publisher_builder()
        .max_loaned_samples(1)
        .initial_max_slice_len(expected)
        .allocation_strategy(AllocationStrategy::PowerOfTwo)
        .backpressure_strategy(BackpressureStrategy::DiscardData)
        .create()
        .map_err(|error| format!("publisher: {error}"))
}

/// A subscriber with the whole buffer of the service.
pub(crate) fn subscriber(service: &Bytes) -> Result<BytesSubscriber, Cause> {
    service.subscriber_builder().create().map_err(|error| format!("subscriber: {error}"))
}

/// Sends one sample and returns how many subscribers it reached.
pub(crate) fn send(publisher: &BytesPublisher, bytes: &[u8]) -> Result<usize, Cause> {
    let sample = publisher.loan_slice_uninit(bytes.len()).map_err(|error| format!("loan: {error}"))?;
    sample.write_from_slice(bytes).send().map_err(|error| format!("send: {error}"))
}
