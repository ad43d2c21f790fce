//! The program.
#[cfg(feature = "viewer")]
mod viewer;

fn main() -> anyhow::Result<()> {
    let scene = std::sync::Arc::new(softbox::scene::procedural("torus-knot").unwrap_or_default());
    let mut options = viewer::ViewerOptions::default();
    let mut args = std::env::args().skip(1);
    while let Some(arg) = args.next() {
        match arg.as_str() {
            "--exit-after" => {
                options.exit_after = args
                    .next()
                    .and_then(|s| s.parse().ok())
                    .map(std::time::Duration::from_secs_f64)
            }
            "--log-events" => options.logs_events = true,
            path => options.scene = Some(path.into()),
        }
    }
    viewer::run(&scene, &options)
}
