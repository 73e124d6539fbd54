"""Which folders the wheel holds: each room at the top of the checkout as `seethrough.ROOM`.

All else stands in pyproject.toml, which can list packages but not find them below such names.
"""

from setuptools import find_packages, setup

ROOMS = ("analysis", "benchmarks", "configs", "experiment", "renderer", "tasks")

setup(
    package_dir={"seethrough": "seethrough", **{f"seethrough.{room}": room for room in ROOMS}},
    packages=[
        "seethrough",
        *(
            f"seethrough.{p}"
            for p in find_packages(include=[w for r in ROOMS for w in (r, r + ".*")])
        ),
    ],
)
