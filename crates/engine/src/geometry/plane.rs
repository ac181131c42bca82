//! Vectors in space, and coordinates along a plane.

/// A point of a plane in the coordinates of the plane [m].
pub(crate) type Point = [f64; 2];
/// A point or a direction in space.
pub(crate) type Vertex = [f64; 3];

/// Scalar product.
pub(crate) fn dot(a: Vertex, b: Vertex) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn minus(a: Vertex, b: Vertex) -> Vertex {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn cross(a: Vertex, b: Vertex) -> Vertex {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn unit(a: Vertex) -> Vertex {
    let length = dot(a, a).sqrt();
    a.map(|x| x / length)
}

/// A plane with two axes along it and one normal to it.
#[derive(Debug, Clone)]
pub(crate) struct PlaneAxes {
    /// Where the coordinates are zero [m].
    pub(crate) origin: Vertex,
    /// Two unit vectors along the plane, and its normal.
    axes: [Vertex; 3],
}

impl PlaneAxes {
    /// The plane of a polygon: the first axis along its first edge, the normal to the side from which it turns
    /// counter-clockwise.
    pub(crate) fn of(vertices: &[Vertex]) -> Self {
        let origin = vertices[0];
        let mut area = [0.0; 3];
        for pair in vertices.windows(2) {
            let part = cross(minus(pair[0], origin), minus(pair[1], origin));
            area = core::array::from_fn(|k| area[k] + part[k]);
        }
        let normal = unit(area);
        let edge = minus(vertices[1], origin);
        let off = dot(edge, normal);
        let along = unit(core::array::from_fn(|k| edge[k] - off * normal[k]));
        Self { origin, axes: [along, cross(normal, along), normal] }
    }

    /// The same plane with the opposite normal; the first axis stays.
    pub(crate) fn reversed(&self) -> Self {
        let [along, across, normal] = self.axes;
        Self { origin: self.origin, axes: [along, across.map(|x| -x), normal.map(|x| -x)] }
    }

    /// Whether another plane has the same axes.
    pub(crate) fn parallel(&self, other: &Self) -> bool {
        self.axes == other.axes
    }

    /// Unit normal.
    pub(crate) fn normal(&self) -> Vertex {
        self.axes[2]
    }

    /// Coordinates of a point along the plane, and its height above it [m].
    pub(crate) fn local(&self, vertex: Vertex) -> Vertex {
        let offset = minus(vertex, self.origin);
        self.axes.map(|axis| dot(offset, axis))
    }

    /// Components of a direction along the plane and normal to it.
    pub(crate) fn direction(&self, direction: Vertex) -> Vertex {
        self.axes.map(|axis| dot(direction, axis))
    }

    /// A point of the plane in space.
    pub(crate) fn vertex(&self, [u, v]: Point) -> Vertex {
        core::array::from_fn(|k| self.origin[k] + u * self.axes[0][k] + v * self.axes[1][k])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A plane sloped by 45 deg towards the south: its normal is (0, -1, 1)/sqrt 2.
    #[test]
    fn axes_of_a_sloped_roof() {
        let roof = [[1.0, 0.0, 3.0], [5.0, 0.0, 3.0], [5.0, 4.0, 7.0], [1.0, 4.0, 7.0]];
        let plane = PlaneAxes::of(&roof);
        let half = 0.5_f64.sqrt();
        let normal = plane.normal();
        assert!(
            normal[0].abs() < 1e-15 && (normal[1] + half).abs() < 1e-15 && (normal[2] - half).abs() < 1e-15
        );
        // The opposite corner is 4 m along the eave and 4 sqrt 2 m up the slope.
        let [u, v, height] = plane.local(roof[2]);
        assert!((u - 4.0).abs() < 1e-12 && (v - 4.0 * 2.0_f64.sqrt()).abs() < 1e-12 && height.abs() < 1e-12);
        let back = plane.vertex([u, v]);
        assert!((0..3).all(|k| (back[k] - roof[2][k]).abs() < 1e-12));
        // The vertical has the component 1/sqrt 2 along the slope and along the normal.
        let up = plane.direction([0.0, 0.0, 1.0]);
        assert!(up[0].abs() < 1e-15 && (up[1] - half).abs() < 1e-15 && (up[2] - half).abs() < 1e-15);
    }
}
