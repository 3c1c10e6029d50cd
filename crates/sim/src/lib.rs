//! The world: bodies, effects, actuators, integrators and the step.
