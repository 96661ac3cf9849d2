"""Text files, written beside their place and renamed."""
import json
import os


def write_text(path, text):
    with open(f"{path}.part", "w") as file:
        file.write(text)
    os.replace(f"{path}.part", path)


def write_json(path, value):
    write_text(path, json.dumps(value, indent=1) + "\n")
