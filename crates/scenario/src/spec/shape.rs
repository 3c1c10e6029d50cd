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

/// Form and sizes of a shape; its origin is its centre, where it does not say otherwise.
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
    /// A drogue: the inside of a cone frustum about z. Its mouth is in z = 0 and opens to +z.
    InnerCone {
        /// Angle between wall and axis, degrees.
        #[schemars(extend("exclusiveMinimum" = 0.0, "exclusiveMaximum" = 90.0))]
        half_angle_deg: f64,
        /// From mouth to throat along the axis, m.
        #[schemars(extend("exclusiveMinimum" = 0.0))]
        depth_m: f64,
        /// Inner radius at the throat, m; zero (default) where the cone closes.
        #[serde(default)]
        #[schemars(range(min = 0.0))]
        throat_radius_m: f64,
        /// Thickness of the wall behind the inner surface, m; rims are rounded by half of it. Default 0.01.
        #[serde(default = "wall")]
        #[schemars(extend("exclusiveMinimum" = 0.0))]
        wall_m: f64,
    },
    /// A socket or bore: the inside of a tube about z. Its mouth is in z = 0 and opens to +z.
    InnerCylinder {
        /// Inner radius, m.
        #[schemars(extend("exclusiveMinimum" = 0.0))]
        radius_m: f64,
        /// From the mouth to the floor or the other end, m.
        #[schemars(extend("exclusiveMinimum" = 0.0))]
        depth_m: f64,
        /// Thickness of wall and floor, m; rims are rounded by half of it. Default 0.01.
        #[serde(default = "wall")]
        #[schemars(extend("exclusiveMinimum" = 0.0))]
        wall_m: f64,
        /// Whether the lower end is closed by a floor.
        #[serde(default)]
        floor: bool,
    },
    /// A torus about z: a soft-capture ring.
    Ring {
        /// Radius of the circle in z = 0, m.
        #[schemars(extend("exclusiveMinimum" = 0.0))]
        major_radius_m: f64,
        /// Radius of the cross-section, m.
        #[schemars(extend("exclusiveMinimum" = 0.0))]
        minor_radius_m: f64,
    },
    /// A guide petal: a rounded plate, the sector of a cone about z that is centred on +x, its base in z = 0.
    Petal {
        /// Radius of the plate's middle surface at its base, m.
        #[schemars(extend("exclusiveMinimum" = 0.0))]
        base_radius_m: f64,
        /// The same at its tip, m: smaller leans inward and tapers in proportion.
        #[schemars(range(min = 0.0))]
        tip_radius_m: f64,
        /// Height of the tip above the base, m.
        #[schemars(extend("exclusiveMinimum" = 0.0))]
        height_m: f64,
        /// Half the angle that it spans about z, degrees.
        #[schemars(extend("exclusiveMinimum" = 0.0, "exclusiveMaximum" = 180.0))]
        half_sector_deg: f64,
        /// Thickness of the plate, m; edges are rounded by half of it.
        #[schemars(extend("exclusiveMinimum" = 0.0))]
        thickness_m: f64,
    },
    /// Everything below the plane z = 0 of its pose; its outward normal is +z.
    HalfSpace,
}

/// Thickness of a wall that is not told, m.
fn wall() -> f64 {
    0.01
}
