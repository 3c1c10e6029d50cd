//! Shapes, contact points with identity, and normal laws, on parry3d.
