//! The extended bristle friction law, standalone.
