#!/usr/bin/env python3
"""Writes a recording of a free body as a ROS 2 bag: poses and rates as PoseStamped and Imu messages, one MCAP file a run.

    pip install mcap==1.6.0 mcap-ros2-support==0.6.0
    python3 bag.py RECORDING OUT

Stamps are those of the recording, some fifty years after the epoch of the clock; messages are logged 3 ms later. OUT/recording.toml maps
the topics back to channels.
"""
import csv
import pathlib
import sys
import tomllib

from mcap_ros2.writer import Writer

HEADER = """std_msgs/Header header
%s
================================================================================
MSG: std_msgs/Header
builtin_interfaces/Time stamp
string frame_id
================================================================================
MSG: builtin_interfaces/Time
int32 sec
uint32 nanosec
"""
PARTS = """================================================================================
MSG: geometry_msgs/Point
float64 x
float64 y
float64 z
================================================================================
MSG: geometry_msgs/Vector3
float64 x
float64 y
float64 z
================================================================================
MSG: geometry_msgs/Quaternion
float64 x
float64 y
float64 z
float64 w
"""
POSE = HEADER % "geometry_msgs/Pose pose" + PARTS + """================================================================================
MSG: geometry_msgs/Pose
geometry_msgs/Point position
geometry_msgs/Quaternion orientation
"""
IMU = HEADER % """geometry_msgs/Quaternion orientation
float64[9] orientation_covariance
geometry_msgs/Vector3 angular_velocity
float64[9] angular_velocity_covariance
geometry_msgs/Vector3 linear_acceleration
float64[9] linear_acceleration_covariance""" + PARTS
BODY = "body.target"
EPOCH_S = 1_795_000_000
LATE_NS = 3_000_000


def vector(row, quantity, axes):
    cells = [row[f"{BODY}.{quantity}.{axis}"] for axis in axes]
    return dict(zip(axes, map(float, cells))) if all(cells) else None


def header(row):
    whole, _, part = row["t"].partition(".")
    return {"stamp": {"sec": EPOCH_S + int(whole), "nanosec": int(part.ljust(9, "0")[:9] or 0)}, "frame_id": "inertial"}


def write(table, bag):
    with open(table, newline="") as source, open(bag, "wb") as sink:
        writer = Writer(sink)
        pose = writer.register_msgdef("geometry_msgs/msg/PoseStamped", POSE)
        imu = writer.register_msgdef("sensor_msgs/msg/Imu", IMU)
        for row in csv.DictReader(source):
            head = header(row)
            stamp = head["stamp"]["sec"] * 1_000_000_000 + head["stamp"]["nanosec"]
            times = {"log_time": stamp + LATE_NS, "publish_time": stamp}
            orientation = vector(row, "orientation", "wxyz")
            rate = vector(row, "angular_velocity", "xyz")
            if orientation:
                place = {"position": {"x": 0.0, "y": 0.0, "z": 0.0}, "orientation": orientation}
                writer.write_message("/target/pose", pose, {"header": head, "pose": place}, **times)
            if rate:
                none = {"x": 0.0, "y": 0.0, "z": 0.0}
                message = {
                    "header": head,
                    "orientation": {"x": 0.0, "y": 0.0, "z": 0.0, "w": 1.0},
                    "orientation_covariance": [-1.0] + [0.0] * 8,
                    "angular_velocity": rate,
                    "angular_velocity_covariance": [0.0] * 9,
                    "linear_acceleration": none,
                    "linear_acceleration_covariance": [0.0] * 9,
                }
                writer.write_message("/target/imu", imu, message, **times)
        writer.finish()


def main(folder, out):
    out.mkdir(parents=True, exist_ok=True)
    manifest = tomllib.loads((folder / "recording.toml").read_text())
    lines = ["format = 1", f'rig = "{manifest["rig"]}"', f'title = "{manifest.get("title", "")}"', "", "[noise]"]
    lines += [f'"{channel}" = {sigma}' for channel, sigma in manifest.get("noise", {}).items()]
    lines += ["", "[channels]"]
    lines += [f'"{BODY}.orientation.{k}" = {{ column = "target/pose.orientation.{k}" }}' for k in "wxyz"]
    lines += [f'"{BODY}.angular_velocity.{k}" = {{ column = "target/imu.angular_velocity.{k}" }}' for k in "xyz"]
    for run in manifest["run"]:
        name = pathlib.Path(run["file"]).stem + ".mcap"
        write(folder / run["file"], out / name)
        lines += ["", "[[run]]", f'file = "{name}"', f'role = "{run["role"]}"', f'note = "{run.get("note", "")}"']
    (out / "recording.toml").write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main(pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2]))
