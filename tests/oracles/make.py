"""Asks R again for every value that the report is held to; needs Rscript (README.md here).

python tests/oracles/make.py [CASE | DESIGN …]
"""

from __future__ import annotations

import json
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
sys.path[:0] = [str(ROOT), str(ROOT / "tests" / "support")]

from made_designs import DESIGNS, make_design  # noqa: E402
from r_values import ABOUT, DESIGN_FOLDER  # noqa: E402
from report_cases import CASES  # noqa: E402
from report_folders import PUBLISHED, contents, make_case, write_published  # noqa: E402

from seethrough.analysis.report import Options, make_report  # noqa: E402

PACKAGES = (
    "afex",
    "emmeans",
    "car",
    "lme4",
    "BayesFactor",
    "exactRankTests",
    "jsonlite",
    "psych",
    "ordinal",
)
VERSIONS = (
    "cat(jsonlite::toJSON(as.list(c(R = paste(R.version$major, R.version$minor, sep = '.'), "
    "sapply(c({}), function(p) as.character(packageVersion(p))))), auto_unbox = TRUE))"
)


def rscript(*words: str) -> str:
    """R's output; its complaints go to the terminal, and an error ends this."""
    run = subprocess.run(["Rscript", *words], check=True, stdout=subprocess.PIPE, text=True)
    return run.stdout


def ask(name: str, script: str, *inputs: Path) -> None:
    """Replace a case's tables by what the script says of the inputs."""
    with tempfile.TemporaryDirectory() as draft:
        rscript(str(HERE / script), *map(str, inputs), draft)
        for old in (HERE / name).glob("*.csv"):
            old.unlink()
        (HERE / name).mkdir(exist_ok=True)
        for table in Path(draft).glob("*.csv"):
            shutil.copy(table, HERE / name / table.name)


def ask_design(name: str) -> None:
    """Run the script that a report of this design comes with, and keep what it writes."""
    place = DESIGN_FOLDER / name
    with tempfile.TemporaryDirectory() as draft:
        data = make_design(Path(draft) / "data", DESIGNS[name])
        script = Path(draft) / "analysis.R"
        script.write_text(make_report(data, Options()).script, encoding="utf-8")
        out = Path(draft) / "r_tables"
        rscript(str(script), str(data), str(out))
        shutil.rmtree(place, ignore_errors=True)
        shutil.copytree(out, place)


def main(wanted: list[str]) -> None:
    """Make the named cases, or all of them and the published report's."""
    known = [case.name for case in CASES] + ["published", *DESIGNS]
    if unknown := sorted(set(wanted) - set(known)):
        sys.exit(f"make.py: {unknown[0]}: expected among {', '.join(known)}")
    about = HERE / ABOUT
    made = json.loads(about.read_text()) if about.exists() else {"folders": {}}
    for case in CASES:
        if wanted and case.name not in wanted:
            continue
        print(case.name, flush=True)
        with tempfile.TemporaryDirectory() as place:
            folder = make_case(case, Path(place) / "data")
            ask(case.name, "report.R", folder)
            made["folders"][case.name] = contents(folder)
    if not wanted or "published" in wanted:
        print("published", flush=True)
        data = HERE / PUBLISHED
        write_published(data)
        study = ROOT / "configs" / "published.toml"
        ask("published", "published.R", ROOT / "analysis/published/published.toml", study, data)
    for name in DESIGNS:
        if not wanted or name in wanted:
            print(name, flush=True)
            ask_design(name)
    quoted = ", ".join(f"'{name}'" for name in PACKAGES)
    made["made_with"] = json.loads(rscript("-e", VERSIONS.format(quoted)))
    made["folders"] = {c.name: made["folders"].get(c.name) for c in CASES}
    about.write_text(json.dumps(made, indent=2) + "\n")


if __name__ == "__main__":
    main(sys.argv[1:])
