use std::path::Path;
use std::sync::Arc;

use anyhow::anyhow;
use softbox::io::picture::read_environment;
use softbox::io::{DEFAULT_SCENE, ImportError, Loaded, builtin_names, builtin_scene, load_scene};
use softbox::scene::EnvironmentMap;

use crate::exit::{Failure, Status};
use crate::job::Job;

/// Reads the scene of `job`, its environment map, and adds light to a scene that has none.
pub(crate) fn open(job: &Job) -> Result<Loaded, Failure> {
    let mut loaded = match &job.scene {
        None => builtin_scene(DEFAULT_SCENE).expect("the default scene is built in"),
        Some(path) => open_path(path)?,
    };
    if let Some(path) = &job.environment {
        loaded.scene.environment.map =
            Some(environment_map(path).map_err(Status::Scene.because())?);
    }
    loaded.scene.light_if_dark();
    Ok(loaded)
}

/// Reads a scene file, or gives the built-in scene of that name where there is no such file.
pub(crate) fn open_path(path: &Path) -> Result<Loaded, Failure> {
    let name = path.to_str().filter(|_| !path.exists());
    if let Some(loaded) = name.and_then(builtin_scene) {
        return Ok(loaded);
    }
    let mut ignore_progress = |_| std::ops::ControlFlow::Continue(());
    load_scene(path, &mut ignore_progress).map_err(|error| {
        let error = match error {
            ImportError::NotFound { .. } => {
                let names: Vec<&str> = builtin_names().collect();
                anyhow!("{error} Built in are {}.", names.join(", "))
            }
            error => error.into(),
        };
        Status::Scene.because()(error)
    })
}

/// Reads a picture of the surroundings.
pub(crate) fn environment_map(path: &Path) -> anyhow::Result<EnvironmentMap> {
    let picture = read_environment(path)?;
    Ok(EnvironmentMap {
        path: path.to_owned(),
        image: Arc::new(picture.image),
    })
}
