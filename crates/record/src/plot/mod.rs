//! Plots of a run as one SVG: the signals that matter in a grid, for readers without a viewer.
