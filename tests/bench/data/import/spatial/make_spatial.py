"""Makes spatial.csv beside this file: python3 make_spatial.py (NumPy and SciPy of Debian 12).

A tool that turns past half a turn, its orientation in every form that `kerf import` takes, by SciPy's Rotation; a
wrench in the sensor's frame about a point of the sensor and in the world's about a point of the world; and what a
recording of six axes holds of it. Rotation vectors r are prescribed, without jumps. Torques of the axes follow from the
power: t_i = M . w_i, w_i the angular velocity when r_i alone grows, by central differences of SciPy's rotations.
"""

import pathlib

import numpy as np
from scipy.spatial.transform import Rotation

ROWS = 25
SENSOR_POINT = np.array([0.01, -0.02, 0.03])
WORLD_POINT = np.array([0.1, 0.2, -0.3])

s = np.linspace(0.0, 1.0, ROWS)
axis = np.stack([np.cos(0.7 * s), np.sin(0.7 * s), 0.4 + 0.3 * s], axis=1)
r = (0.2 + 4.8 * s)[:, None] * axis / np.linalg.norm(axis, axis=1)[:, None]
turn = Rotation.from_rotvec(r)
position = np.stack([0.1 * np.sin(3 * s), 0.05 * s, 0.02 - 0.03 * s], axis=1)
force = np.stack([1 + s, np.cos(4 * s), -2 * s], axis=1)  # on the tool, in the world's axes
moment = np.stack([0.02 * s, 0.03 - 0.01 * s, 0.05 * np.sin(2 * s)], axis=1)  # about the position


def angular_velocity_of(vector, i, h=1e-5):
    step = h * np.eye(3)[i]
    ahead, behind = Rotation.from_rotvec(vector + step), Rotation.from_rotvec(vector - step)
    return (ahead * behind.inv()).as_rotvec() / (2 * h)


torque = np.array([[m @ angular_velocity_of(v, i) for i in range(3)] for v, m in zip(r, moment)])
sensor_force = turn.inv().apply(force)
sensor_torque = turn.inv().apply(moment) - np.cross(SENSOR_POINT, sensor_force)
world_torque = moment - np.cross(WORLD_POINT - position, force)

quaternion = turn.as_quat() * np.where(np.arange(ROWS) % 3 == 1, -1.0, 1.0)[:, None]  # q and -q are the same
matrix = turn.as_matrix()
columns = {
    "t_s": s, "x_mm,y_mm,z_mm": 1000.0 * position,
    "qx,qy,qz,qw": quaternion, "pw,px,py,pz": quaternion[:, [3, 0, 1, 2]],
    "v1,v2,v3": turn.as_rotvec(), "d1,d2,d3": turn.as_rotvec(degrees=True),
    "ea,eb,ec": turn.as_euler("xyz", degrees=True), "fa,fb,fc": turn.as_euler("ZYX"),
    "ga,gb,gc": turn.as_euler("ZXZ", degrees=True), "ha,hb,hc": turn.as_euler("yxz"),
    ",".join("m%d%d" % (i, j) for i in (1, 2, 3) for j in (1, 2, 3)): matrix.reshape(ROWS, 9),
    ",".join("n%d%d" % (i, j) for j in (1, 2, 3) for i in (1, 2, 3)): matrix.transpose(0, 2, 1).reshape(ROWS, 9),
    "sfx_N,sfy_N,sfz_N,stx_Nm,sty_Nm,stz_Nm": np.hstack([sensor_force, sensor_torque]),
    "wfx_N,wfy_N,wfz_N,wtx_Nm,wty_Nm,wtz_Nm": np.hstack([force, world_torque]),
    "rx,ry,rz": r, "Fx,Fy,Fz,Tx,Ty,Tz": np.hstack([force, torque]),
}
table = np.hstack([v.reshape(ROWS, -1) for v in columns.values()])
np.savetxt(pathlib.Path(__file__).with_name("spatial.csv"), table, fmt="%.12g", delimiter=",",
           header=",".join(columns), comments="")
