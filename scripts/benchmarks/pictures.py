"""Pictures of meshes and clouds with numpy alone: parallel projection, points on the surface into a depth buffer."""
import numpy as np
from PIL import Image

LIGHTS = ((0.7, (0.4, 0.5, 0.8)), (0.25, (-0.8, 0.1, 0.4)))
SKIN, OVERLAY = np.array([215, 185, 160]), np.array([200, 40, 40])


def _dense(vertices, faces, step):
    """Points on the surface about `step` apart with unit normals; for a cloud the points and no normals."""
    if not len(faces):
        return vertices, None
    a, b, c = (vertices[faces[:, k]] for k in range(3))
    normal = np.cross(b - a, c - a)
    divisions = np.clip(np.ceil(np.sqrt(np.linalg.norm(normal, axis=1)) / step), 1, 40).astype(int)
    points, normals = [], []
    for s in np.unique(divisions):
        own = divisions == s
        for i in range(s + 1):
            for j in range(s + 1 - i):
                points.append(a[own] + (b[own] - a[own]) * (i / s) + (c[own] - a[own]) * (j / s))
                normals.append(normal[own])
    normal = np.concatenate(normals)
    return np.concatenate(points), normal / np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 1e-20)


def camera(up=(0, 1, 0), front=(0, 0, 1), yaw_degrees=0.0, pitch_degrees=0.0):
    """Rotation from the scene to a camera's right, up and toward-the-viewer axes."""
    up = np.asarray(up, float) / np.linalg.norm(up)
    front = np.asarray(front, float) - np.dot(front, up) * up
    front /= np.linalg.norm(front)
    scene = np.stack([np.cross(up, front), up, front])
    yaw, pitch = np.radians([yaw_degrees, pitch_degrees])
    turn = np.array([[np.cos(yaw), 0, -np.sin(yaw)], [0, 1, 0], [np.sin(yaw), 0, np.cos(yaw)]])
    tilt = np.array([[1, 0, 0], [0, np.cos(pitch), -np.sin(pitch)], [0, np.sin(pitch), np.cos(pitch)]])
    return tilt @ turn @ scene


def view(vertices, faces, rotation, frame=None, size=320, colour=SKIN):
    """A picture (size,size,3). frame: (centre, half extent) in scene units, by default the mesh's own."""
    centre, half = frame if frame is not None else frame_of(vertices)
    scale = 0.47 * size / half
    points, normals = _dense((vertices - centre) @ rotation.T * scale, faces, 0.6)
    x, y = (size / 2 + points[:, 0]).astype(int), (size / 2 - points[:, 1]).astype(int)
    inside = (x >= 0) & (y >= 0) & (x < size) & (y < size)
    if normals is None:
        depth = points[:, 2]
        light = 0.45 + 0.5 * (depth - depth.min()) / max(np.ptp(depth), 1e-9)
    else:
        inside &= normals[:, 2] > 0
        light = 0.15 + sum(strength * np.maximum(0, normals @ toward / np.linalg.norm(toward)) for strength, toward in LIGHTS)
    order = np.nonzero(inside)[0]
    order = order[np.argsort(points[order, 2], kind="stable")]
    picture = np.full((size, size, 3), 255, np.uint8)
    picture[y[order], x[order]] = (np.asarray(colour) * light[order, None]).clip(0, 255)
    return picture


def frame_of(vertices):
    low, high = vertices.min(0), vertices.max(0)
    return (low + high) / 2, max(np.linalg.norm(high - low) / 2, 1e-9)


def beside(scan, registered, up, front, size=260):
    """Scan and registered body (or None), each (vertices, faces), from the front and from the left, in one picture."""
    frame = frame_of(scan[0] if registered is None else registered[0])
    rows = []
    for yaw in (0, 90):
        rotation = camera(up, front, yaw)
        rows.append(view(*scan, rotation, frame, size))
        rows.append(np.full((size, size, 3), 255, np.uint8) if registered is None
                    else view(*registered, rotation, frame, size, np.array([150, 190, 225])))
    return Image.fromarray(np.concatenate(rows, 1))
