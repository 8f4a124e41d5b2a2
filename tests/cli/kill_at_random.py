#!/usr/bin/env python3
"""Kills `fit`, `convert` and `export` at random moments and looks at what is left: each result must be the old file or a whole new
one, and nothing else may lie in the folder.

kill_at_random.py PROGRAM MEASUREMENT KILLS [SEED]     ctest runs it with a few kills; by hand: 1000
"""
import hashlib
import json
import os
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time

program, measurement, kills, seed = sys.argv[1], sys.argv[2], int(sys.argv[3]), int(sys.argv[4]) if len(sys.argv) > 4 else 1
draw = random.Random(seed)


def digest(path):
    with open(path, "rb") as file:
        return hashlib.sha256(file.read()).hexdigest()


def is_whole(path):
    """Whether a file whose bytes differ from run to run (it holds times) is complete."""
    with open(path, "rb") as file:
        data = file.read()
    if path.endswith(".json"):
        try:
            json.loads(data)
            return True
        except ValueError:
            return False
    if path.endswith(".png"):
        return data.endswith(b"IEND\xaeB\x60\x82")
    return path.endswith(".html") and data.endswith(b"</html>\n")


def run(command, folder, seconds=None, with_signal=None):
    child = subprocess.Popen([program, *command], cwd=folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    if seconds is not None:
        time.sleep(seconds)
        child.send_signal(with_signal)
    return child.wait()


with tempfile.TemporaryDirectory() as top:
    start = os.path.join(top, "start")
    os.mkdir(start)
    shutil.copy(measurement, os.path.join(start, "a.csv"))
    if run(["fit", "a.csv", "--recipe", "ggx", "--no-report", "--name", "m"], start) != 0:
        sys.exit("the fit of the measurement failed")
    commands = {
        "convert": ["convert", "a.csv", "b.csv"],
        "export": ["export", "m.material.json", "--to", "mitsuba,pbrt,glsl,csv,json", "--name", "e", "--threads", "1"],
        "fit": ["fit", "a.csv", "--recipe", "ggx", "--name", "f", "--starts", "1"],
    }
    whole, lasts = {}, {}
    for verb, command in commands.items():
        folder = os.path.join(top, verb)
        shutil.copytree(start, folder)
        began = time.monotonic()
        if run(command, folder) != 0:
            sys.exit(f"{verb} failed")
        lasts[verb] = time.monotonic() - began
        whole[verb] = {name: digest(os.path.join(folder, name)) for name in os.listdir(folder)}
    killed = 0
    for number in range(kills):
        verb = draw.choice(list(commands))
        folder = os.path.join(top, f"run{number}")
        shutil.copytree(start, folder)
        inputs = {name: digest(os.path.join(folder, name)) for name in os.listdir(folder)}
        names = [name for name in whole[verb] if name not in inputs]
        old = "old content, to be kept or replaced\n"
        for name in names:
            if draw.random() < 0.5:
                with open(os.path.join(folder, name), "w") as file:
                    file.write(old)
        before = {name: digest(os.path.join(folder, name)) for name in os.listdir(folder)}
        with_signal = draw.choice([signal.SIGKILL, signal.SIGTERM, signal.SIGINT])
        killed += run(commands[verb], folder, draw.uniform(0, 1.05 * lasts[verb]), with_signal) < 0
        for name in os.listdir(folder):
            path = os.path.join(folder, name)
            is_old = before.get(name) == digest(path)
            is_new = name in names and (whole[verb][name] == digest(path) or is_whole(path))
            if not is_old and not is_new:
                sys.exit(f"kill {number} of {verb} by {with_signal.name} left {name}, {os.path.getsize(path)} bytes, neither old nor whole")
        for name in inputs:
            if not os.path.exists(os.path.join(folder, name)):
                sys.exit(f"kill {number} of {verb} took the input {name}")
        shutil.rmtree(folder)
    print(f"{kills} runs, {killed} killed before their end: every file is the old or the whole new one")
