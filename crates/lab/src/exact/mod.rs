//! Closed forms that need more than a line, and event-exact references: independent of the simulator.
