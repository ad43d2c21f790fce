//! Latency of a running session: from a new camera to its first look, and what a snapshot costs.
//!
//! `cargo bench --bench session -- --bench [SCENE]` prints medians and 95th percentiles of wall
//! time; the machine should be quiet.

use std::io::Write;
use std::sync::Arc;
use std::sync::mpsc::channel;
use std::time::{Duration, Instant};

use softbox::io::builtin_scene;
use softbox::scene::initial_camera;
use softbox::session::{RenderJob, RenderSession, SessionOptions};
use softbox::settings::{CameraRule, RenderSettings};

const MOVES: usize = 120;
const BETWEEN: Duration = Duration::from_millis(25);

fn main() -> std::io::Result<()> {
    let words: Vec<String> = std::env::args().collect();
    if !words.iter().any(|word| word == "--bench") {
        return Ok(());
    }
    let name = words
        .iter()
        .skip(1)
        .find(|word| !word.starts_with("--"))
        .map_or("knot-70k", String::as_str);
    let Some(loaded) = builtin_scene(name) else {
        return Err(std::io::Error::other(format!(
            "there is no built-in scene '{name}'"
        )));
    };
    let scene = Arc::new(loaded.scene);
    let mut job = RenderJob {
        camera: initial_camera(&scene, CameraRule::Auto, false),
        scene,
        settings: RenderSettings {
            width: 1280,
            height: 960,
            ..RenderSettings::default()
        },
    };
    let (wake, woken) = channel();
    let session = RenderSession::new(SessionOptions { interactive: true }, move || {
        let _ = wake.send(Instant::now());
    });
    session.request(job.clone());
    std::thread::sleep(Duration::from_secs(2));
    let mut latencies = Vec::new();
    for _ in 0..MOVES {
        while woken.try_recv().is_ok() {}
        job.camera.eye.x += 0.002;
        let asked = Instant::now();
        session.request(job.clone());
        loop {
            let at = woken.recv().expect("the session lives");
            if session
                .snapshot()
                .is_some_and(|snapshot| snapshot.camera == job.camera)
            {
                latencies.push(at - asked);
                break;
            }
        }
        std::thread::sleep(BETWEEN);
    }
    latencies.sort();
    let at = |share: f64| latencies[((MOVES - 1) as f64 * share) as usize].as_secs_f64() * 1e3;
    let mut out = std::io::stdout().lock();
    writeln!(
        out,
        "{name}: new camera to its first look: median {:.1} ms, p95 {:.1} ms, max {:.1} ms",
        at(0.5),
        at(0.95),
        at(1.0)
    )
}
