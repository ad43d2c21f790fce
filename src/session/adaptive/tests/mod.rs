mod allotment;
mod coverage;
mod synthetic;
