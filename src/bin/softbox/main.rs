//! The program: `softbox [SCENE]` opens the window, everything else works without one.

mod args;
mod bench;
mod bench_args;
mod bench_rays;
mod command_line;
mod compare;
mod contender;
mod course_args;
mod exit;
mod info;
mod interrupt;
mod isa;
mod job;
#[cfg(not(feature = "viewer"))]
mod no_viewer;
mod open;
mod place_camera;
mod progress;
mod provenance;
mod ray_bench;
mod render;
mod report;
mod settings_args;
mod shown;
mod values;
#[cfg(feature = "viewer")]
mod viewer;

use std::io::Write;
use std::process::ExitCode;

use args::Request;
use exit::Failure;
#[cfg(not(feature = "viewer"))]
use no_viewer as viewer;

fn main() -> ExitCode {
    let forced = std::env::var_os(isa::VARIABLE);
    let request = match args::parse(std::env::args_os(), forced.as_deref()) {
        Ok(request) => request,
        // Prints to the right stream; status 2 for errors, 0 for help and version.
        Err(error) => error.exit(),
    };
    match run(request) {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            let mut stderr = std::io::stderr().lock();
            // Nobody is left to tell when this fails as well.
            let _ = writeln!(stderr, "softbox: {}", failure.message());
            failure.status.into()
        }
    }
}

fn run(request: Request) -> Result<(), Failure> {
    match request {
        Request::View(job, options) => viewer::run(&job, &options),
        Request::Render(job, reporting) => render::run(&job, &reporting),
        Request::Info(info) => info::run(&info),
        Request::Compare(compare) => compare::run(&compare),
        Request::Bench(bench) => bench::run(&bench),
        Request::BenchRays(bench) => bench_rays::run(&bench),
    }
}
