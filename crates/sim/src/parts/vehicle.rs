//! Vehicles: a tree on a base, and where its coordinates stand among those of the world.

use multibody::Tree;

/// How a vehicle's base moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Base {
    /// Six freedoms.
    Free,
    /// None: bolted to W.
    Fixed,
    /// Only the marked components of its twist, W axes: angular x, y, z, then linear x, y, z.
    Only([bool; 6]),
    /// Moves as this one of [`crate::Model::drives`] says, whatever the forces; see [`crate::Model::with_drives`].
    Driven(usize),
}

impl Base {
    /// Whether no force moves it.
    pub fn is_held(&self) -> bool {
        matches!(self, Self::Fixed | Self::Driven(_))
    }

    /// The free components: angular x, y, z, then linear x, y, z.
    pub fn mask(&self) -> [bool; 6] {
        match self {
            Self::Free => [true; 6],
            Self::Fixed | Self::Driven(_) => [false; 6],
            Self::Only(mask) => *mask,
        }
    }
}

/// One robot or spacecraft in the world.
#[derive(Clone, Debug)]
pub struct Vehicle {
    /// Unique name.
    pub name: String,
    /// Its tree.
    pub tree: Tree,
    /// How its base moves.
    pub base: Base,
    /// First index into the world's `q`.
    pub q0: usize,
    /// First index into the world's `v`.
    pub v0: usize,
    /// Global index of its base body.
    pub body0: usize,
}

impl Vehicle {
    /// Its part of the world's `q`.
    pub fn q_range(&self) -> std::ops::Range<usize> {
        self.q0..self.q0 + self.tree.nq
    }

    /// Its part of the world's `v`.
    pub fn v_range(&self) -> std::ops::Range<usize> {
        self.v0..self.v0 + self.tree.nv
    }
}

/// One vehicle, before it is numbered.
#[derive(Clone, Debug)]
pub struct VehicleSpec {
    /// Unique name.
    pub name: String,
    /// Its tree, rotors included.
    pub tree: Tree,
    /// How its base moves.
    pub base: Base,
}
