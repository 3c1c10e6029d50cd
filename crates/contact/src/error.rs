//! What can be wrong with a scene or a law, as sentences that name the collider.

/// Why a scene or a normal law cannot be used.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ContactError {
    /// A radius, length or half extent is not a positive finite number.
    #[error("collider \"{collider}\": {quantity} is {value} m; it must be finite and greater than zero")]
    Size {
        /// Name of the collider.
        collider: String,
        /// Which size.
        quantity: &'static str,
        /// The number given, m.
        value: f64,
    },
    /// An angle of a docking shape is out of its range.
    #[error(
        "collider \"{collider}\": {quantity} is {value_deg}°; it must be greater than 0° and less than {below_deg}°"
    )]
    Angle {
        /// Name of the collider.
        collider: String,
        /// Which angle.
        quantity: &'static str,
        /// The angle given, degrees.
        value_deg: f64,
        /// What it must stay below, degrees.
        below_deg: f64,
    },
    /// A vertex or the pose is NaN or infinite.
    #[error("collider \"{collider}\": {what} is not a finite number; check the file that it was read from")]
    NotFinite {
        /// Name of the collider.
        collider: String,
        /// What is not finite.
        what: String,
    },
    /// The points of a convex hull span no volume.
    #[error(
        "collider \"{collider}\": the {points} points of its convex hull span no volume; \
         give at least four points that do not lie in one plane, or use a mesh for a thin sheet"
    )]
    DegenerateHull {
        /// Name of the collider.
        collider: String,
        /// How many points were given.
        points: usize,
    },
    /// A mesh has no triangle of positive area.
    #[error("collider \"{collider}\": its mesh has no triangle with an area ({triangles} given); export it again")]
    DegenerateMesh {
        /// Name of the collider.
        collider: String,
        /// How many triangles were given.
        triangles: usize,
    },
    /// A triangle names a vertex that does not exist.
    #[error("collider \"{collider}\": triangle {triangle} names vertex {vertex}, but there are {vertices} vertices")]
    MeshIndex {
        /// Name of the collider.
        collider: String,
        /// Number of the triangle, from zero.
        triangle: usize,
        /// The vertex it names.
        vertex: usize,
        /// How many there are.
        vertices: usize,
    },
    /// A mesh that has no inside cannot be decomposed.
    #[error(
        "the mesh of {triangles} triangles {what}; a decomposition needs a closed one: close it, or use it as a surface"
    )]
    OpenMesh {
        /// How many triangles it has.
        triangles: usize,
        /// What is wrong with it.
        what: &'static str,
    },
    /// A compound without parts.
    #[error("collider \"{collider}\": a compound needs at least one part")]
    EmptyCompound {
        /// Name of the collider.
        collider: String,
    },
    /// A bed without samples, or with one that has no area, direction or place.
    #[error(
        "collider \"{collider}\": its bed has {fault}; a bed needs samples with finite positions, unit normals and \
         positive areas (m²), and a positive reference area"
    )]
    Bed {
        /// Name of the collider.
        collider: String,
        /// What is wrong.
        fault: String,
    },
    /// A pair names a collider that does not exist.
    #[error("contact pair {pair} names collider {index}, but there are {colliders} colliders")]
    PairIndex {
        /// Number of the pair, from zero.
        pair: usize,
        /// The collider it names.
        index: usize,
        /// How many there are.
        colliders: usize,
    },
    /// A pair of a collider with itself.
    #[error("contact pair {pair} is collider \"{collider}\" with itself; name two different ones")]
    SelfPair {
        /// Number of the pair, from zero.
        pair: usize,
        /// Name of the collider.
        collider: String,
    },
    /// A pair that is named a second time, either way round.
    #[error("contact pair {pair} (\"{}\" and \"{}\") is the same as pair {first}; name it once", names[0], names[1])]
    PairTwice {
        /// Number of the pair, from zero.
        pair: usize,
        /// Names of the two colliders.
        names: [String; 2],
        /// Number of the pair that named them first.
        first: usize,
    },
    /// A parameter of a normal law is out of its range.
    #[error("normal law: {parameter} is {value}; it must be {range}")]
    LawParameter {
        /// Which parameter.
        parameter: &'static str,
        /// The number given.
        value: f64,
        /// What is allowed.
        range: &'static str,
    },
}
