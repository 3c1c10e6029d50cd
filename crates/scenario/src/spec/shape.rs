//! Collision shapes that a scenario adds to those of the URDFs.

use super::pose::PoseSpec;
use super::vehicle::world;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A collision shape on a link or in the world.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Shape {
    /// Unique name; contacts know the shape as `vehicle/name`, or `world/name`.
    #[schemars(extend("x-name" = true))]
    pub name: String,
    /// What it is fixed to: a `vehicle/link`, or "world".
    #[serde(default = "world")]
    #[schemars(extend("x-refers" = "vehicle/part"))]
    pub on: String,
    /// Pose of the shape in the link (in W for "world").
    #[serde(default)]
    pub pose: PoseSpec,
    /// Form and sizes.
    #[serde(flatten)]
    pub kind: ShapeKind,
}

impl Shape {
    /// The name by which contacts know the shape: `vehicle/name`, or `world/name`.
    pub fn place(&self) -> String {
        let owner = self.on.split('/').next().unwrap_or("world");
        format!("{owner}/{}", self.name)
    }
}

/// Form and sizes of a shape; its origin is its centre.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "kebab-case", deny_unknown_fields)]
pub enum ShapeKind {
    /// A cuboid.
    Box {
        /// Whole edge lengths along x, y and z, m.
        #[schemars(extend("items" = { "type": "number", "exclusiveMinimum": 0.0 }))]
        size_m: [f64; 3],
    },
    /// A ball.
    Sphere {
        /// Radius, m.
        #[schemars(extend("exclusiveMinimum" = 0.0))]
        radius_m: f64,
    },
    /// A cylinder along z.
    Cylinder {
        /// Radius, m.
        #[schemars(extend("exclusiveMinimum" = 0.0))]
        radius_m: f64,
        /// Whole length, m.
        #[schemars(extend("exclusiveMinimum" = 0.0))]
        length_m: f64,
    },
    /// A cylinder along z with hemispheres on its ends.
    Capsule {
        /// Radius, m.
        #[schemars(extend("exclusiveMinimum" = 0.0))]
        radius_m: f64,
        /// Length of the cylindrical part, without the hemispheres, m.
        #[schemars(range(min = 0.0))]
        length_m: f64,
    },
    /// A disc in the plane z = 0, facing +z, whose contact is spread over its area (an elastic foundation).
    DiscBed {
        /// Radius, m.
        #[schemars(extend("exclusiveMinimum" = 0.0))]
        radius_m: f64,
        /// Number of samples.
        #[schemars(range(min = 6, max = 100_000))]
        samples: u32,
        /// Area to which the stiffness of the contact's laws belongs, m²; the whole face where absent.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        #[schemars(extend("exclusiveMinimum" = 0.0))]
        reference_area_m2: Option<f64>,
    },
    /// A ring in the plane z = 0, facing +z, whose contact is spread over its area.
    #[schemars(extend("x-ordered" = [["inner_radius_m", "outer_radius_m"]]))]
    RingBed {
        /// Inner radius, m.
        #[schemars(range(min = 0.0))]
        inner_radius_m: f64,
        /// Outer radius, m.
        #[schemars(extend("exclusiveMinimum" = 0.0))]
        outer_radius_m: f64,
        /// Number of samples.
        #[schemars(range(min = 6, max = 100_000))]
        samples: u32,
        /// Area to which the stiffness of the contact's laws belongs, m²; the whole face where absent.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        #[schemars(extend("exclusiveMinimum" = 0.0))]
        reference_area_m2: Option<f64>,
    },
    /// A rectangle in the plane z = 0, facing +z, whose contact is spread over its area.
    RectangleBed {
        /// Whole edge lengths along x and y, m.
        #[schemars(extend("items" = { "type": "number", "exclusiveMinimum": 0.0 }))]
        size_m: [f64; 2],
        /// About how many samples; as many as nearly square cells have.
        #[schemars(range(min = 4, max = 100_000))]
        samples: u32,
        /// Area to which the stiffness of the contact's laws belongs, m²; the whole face where absent.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        #[schemars(extend("exclusiveMinimum" = 0.0))]
        reference_area_m2: Option<f64>,
    },
    /// The surface of a collision geometry of the same link, with contact spread over it; it adds to the geometry, whose own
    /// contacts a `[[contact]]` may switch off.
    SurfaceBed {
        /// Name of the collision element in the URDF.
        of: String,
        /// Distance between samples, m.
        #[schemars(extend("exclusiveMinimum" = 0.0))]
        spacing_m: f64,
        /// Area to which the stiffness of the contact's laws belongs, m²; the whole face where absent.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        #[schemars(extend("exclusiveMinimum" = 0.0))]
        reference_area_m2: Option<f64>,
    },
    /// Everything below the plane z = 0 of its pose; its outward normal is +z.
    HalfSpace,
}
