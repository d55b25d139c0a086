#!/usr/bin/env python3
"""Makes every picture of README.md and docs/, the tables of docs/gallery.md and the page in examples/, from the built programs.

    examples/gallery.py [--build build/release] [--models FOLDER] [--resolution 256] [--only NAME ...]

The carved figures want bunny00.off (of Debian's libcgal-demo, as in examples/bunny.sh), kitten.off and skull_low.obj in
FOLDER; what is not there is named and left as it is. Pictures go through pngquant where that is installed.
"""
import argparse
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
IMAGES = ROOT / "docs/images"
LARGEST_PICTURE = 250_000  # bytes

# What a numbered example is seen from: its models, and the options of `render`.
VIEWS = {
    "01_first_carve": (["01_first_carve"], []),
    "02_own_picture": (["02_own_picture"], []),
    "03_bracket": (["03_bracket"], []),
    "04_loads": (["04_loads"], []),
    "05_orientation": (["05_orientation_up", "05_orientation_vector", "05_orientation_free"], []),
    "06_paper": (["06_paper"], []),
    "07_openscad": (["07_openscad"], []),
    "08_library": (["08_library"], ["--elevation", "38"]),
    "09_lampshade": (["09_lampshade"], ["--elevation", "12"]),
    "10_make": (["10_leafveins", "10_scales"], []),
    "11_slice": (["11_slice"], []),
    "12_marks": (["12_marks"], ["--elevation", "25"]),
    "13_rough_use": (["13_rough_use"], ["--colour", "bridges"]),
}

# Figures: name, model, further options of `carve`, options of `render`.
FIGURES = [
    ("bunny-cells", "bunny00.off", ["--up", "y", "--pattern", "cells"], ["--azimuth", "30"]),
    ("kitten-hooks", "kitten.off", ["--up", "y", "--pattern", "hooks", "--width-mm", "40"], ["--azimuth", "30"]),
    ("skull-celtic", "skull_low.obj", ["--up", "y", "--pattern", "celtic"], ["--azimuth", "30"]),
    ("bunny-waves", "bunny00.off", ["--up", "y", "--pattern", "waves"], ["--azimuth", "30"]),
    ("bunny-zebra", "bunny00.off", ["--up", "y", "--pattern", "zebra"], ["--azimuth", "30"]),
]

# The bunny that lies on its chest, stands, and lies on its back: where its weight pulls, and the tenth that holds it. At
# 100 mm it reaches from -50 to 50 along x.
GRAVITIES = {
    "left": ([-1, 0, 0], ([-60, -60, -60], [-40, 60, 60])),
    "down": ([0, 0, -1], ([-60, -60, -60], [60, 60, -40])),
    "right": ([1, 0, 0], ([40, -60, -60], [60, 60, 60])),
}

# The figure whose page is kept in examples/.
PAGE = "bunny-cells"


def run(*line, **more):
    print("+", *line, flush=True)
    subprocess.run([str(word) for word in line], check=True, **more)


class Gallery:
    def __init__(self, options):
        self.build = ROOT / options.build
        self.fretwork = self.build / "cli/fretwork"
        self.models = options.models
        self.resolution = str(options.resolution)
        self.only = options.only
        self.out = ROOT / "out/gallery"
        self.out.mkdir(parents=True, exist_ok=True)
        IMAGES.mkdir(parents=True, exist_ok=True)

    def wanted(self, name):
        return not self.only or name in self.only

    def publish(self, picture, name):
        """A picture becomes one of the documentation."""
        target = IMAGES / (name + ".png")
        if shutil.which("pngquant"):
            run("pngquant", "--force", "--strip", "--speed", "1", "--output", target, "256", picture)
        else:
            shutil.copyfile(picture, target)
        if target.stat().st_size > LARGEST_PICTURE:
            print(f"warning: {target} has {target.stat().st_size} bytes", file=sys.stderr)

    def render(self, models, size, view, name):
        """Models side by side, each in a square of `size` px."""
        pictures = []
        for model in models:
            pictures.append(self.out / (model.stem + ".png"))
            run(self.fretwork, "render", model, "-q", "--size", size, *view, "-o", pictures[-1])
        sheet = self.out / (name + "-sheet.png")
        run(self.build / "examples/sheet", sheet, len(pictures), *pictures)
        self.publish(sheet, name)

    def example(self, name):
        models, view = VIEWS[name]
        if name == "08_library":
            run(self.build / "examples/example_library", self.out / "08_library.3mf", self.resolution)
        else:
            environment = dict(os.environ, OUT=str(self.out), FRETWORK=str(self.fretwork), RESOLUTION=self.resolution)
            done = subprocess.run(["bash", ROOT / "examples" / (name + ".sh")], env=environment)
            if done.returncode == 77:
                return
            done.check_returncode()
        size = 480 if len(models) == 1 else 400 if len(models) == 2 else 320
        self.render([self.out / (m + ".3mf") for m in models], f"{size}x480", view, name)

    def patterns(self):
        sheet = self.out / "patterns-sheet.png"
        run(self.build / "examples/pattern_sheet", sheet)
        self.publish(sheet, "patterns")

    def vases(self):
        names = [p["name"] for p in json.loads(subprocess.check_output([self.fretwork, "pattern", "list", "--json"]))]
        vase = self.out / "vase.off"
        vase.write_bytes(subprocess.check_output(["awk", "-f", ROOT / "examples/models/vase.awk"]))
        pictures = []
        for name in names:
            model = self.out / f"vase-{name}.3mf"
            run(self.fretwork, "carve", vase, "-q", "--pattern", ROOT / "examples/vase.toml", "-D",
                f"exemplar.pattern={name}", "--resolution", self.resolution, "-o", model)
            pictures.append(self.out / f"vase-{name}.png")
            run(self.fretwork, "render", model, "-q", "--size", "160x192", "-o", pictures[-1])
        sheet = self.out / "patterns-vase-sheet.png"
        run(self.build / "examples/sheet", sheet, 6, *pictures)
        self.publish(sheet, "patterns-vase")

    def source(self, name, model):
        """The model of a figure; none where it is not there."""
        source = self.models / model if self.models else None
        if source is not None and source.exists():
            return source
        print(f"skipped: {name}: {model} is not in the folder of models", file=sys.stderr)
        return None

    def gravities(self, name):
        """What is added to the same pattern when the weight pulls elsewhere (the paper's figure 17)."""
        source = self.source(name, "bunny00.off")
        if source is None:
            return
        made = []
        for side, (gravity, (low, high)) in GRAVITIES.items():
            spec = self.out / f"{name}-{side}.toml"
            spec.write_text(f"[input]\nup = \"y\"\nsize_mm = 100\n[exemplar]\npattern = \"hooks\"\n"
                            f"[structure]\nprofile = \"gravity\"\ngravity = {gravity}\n"
                            f"[[fixtures]]\nname = \"below\"\nshape = \"box\"\nmin_mm = {low}\nmax_mm = {high}\n")
            made.append(spec.with_suffix(".3mf"))
            run(self.fretwork, "carve", source, "-q", "--pattern", spec, "--resolution", self.resolution,
                "-o", made[-1])
        self.render(made, "480", ["--colour", "bridges", "--azimuth", "0"], name)

    def figure(self, name, model, carve, view):
        source = self.source(name, model)
        if source is None:
            return
        made, summary = self.out / (name + ".3mf"), self.out / (name + ".json")
        run(self.fretwork, "carve", source, "-q", "--size-mm", "100", *carve, "--resolution", self.resolution,
            "-o", made, "--summary", summary, "--report", self.out / (name + ".html"))
        if name == PAGE:
            shutil.copyfile(self.out / (name + ".html"), ROOT / "examples" / (name + ".html"))
        self.render([made], "800", view, name)
        back = self.out / (name + "-back.png")
        run(self.fretwork, "render", made, "-q", "--size", "480", "--azimuth", "210", "-o", back)
        self.publish(back, name + "-back")
        write_numbers(name, json.loads(summary.read_text()))


def numbers(report):
    """What a run did, as a line and a table."""
    mesh, pattern, structure = report["mesh"], report["pattern"], report["structure"]
    valid = "closed, manifold" if mesh["closed"] and mesh["manifold"] else "not closed"
    pieces = pattern["components_after"]
    lines = [
        f"{report['shell']['resolution']} voxels along the longest side; {mesh['triangles']:,} triangles, {valid}, "
        f"{mesh['self_intersections']} self-intersections, "
        f"{pieces} {'piece' if pieces == 1 else 'pieces'}; {100 * pattern['solid_fraction']:.0f} % solid "
        f"(example {100 * pattern['exemplar_solid_fraction']:.0f} %); {pattern['components_before']} pieces after the "
        "first synthesis.",
        "",
        "| turn | pieces | bridges: connect, stress, geodesic | voxels added | max score MPa | p99 MPa |",
        "|---|---|---|---|---|---|",
    ]
    for turn in report["iterations"]:
        bridges = turn["bridges"]
        lines.append(f"| {turn['iteration']} | {turn['components']} | {bridges['connect']}, {bridges['stress']}, "
                     f"{bridges['geodesic']} | {turn['voxels_added']} | {turn['max_score_pa'] / 1e6:.1f} | "
                     f"{turn['p99_score_pa'] / 1e6:.1f} |")
    lines += ["", f"Stopped by: {structure['stopped_by']}; allowable {structure['allowable_pa'] / 1e6:.0f} MPa, largest "
              f"{structure['max_pa'] / 1e6:.1f} MPa."]
    return "\n".join(lines)


def write_numbers(name, report):
    """Replaces what stands between the marks of `name` in docs/gallery.md."""
    page = ROOT / "docs/gallery.md"
    begin, end = f"<!-- numbers of {name} -->", "<!-- end of numbers -->"
    text, count = re.subn(re.escape(begin) + ".*?" + re.escape(end),
                          lambda _: f"{begin}\n{numbers(report)}\n{end}", page.read_text(), flags=re.DOTALL)
    if count != 1:
        raise SystemExit(f"docs/gallery.md: found {count} marks {begin}, expected one")
    page.write_text(text)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", default="build/release", help="folder of the built programs")
    parser.add_argument("--models", type=pathlib.Path, help="folder with the figures' models")
    parser.add_argument("--resolution", type=int, default=256, help="voxels along the longest side")
    parser.add_argument("--only", nargs="+", default=[], help="names of pictures in docs/images")
    gallery = Gallery(parser.parse_args())
    if gallery.wanted("patterns"):
        gallery.patterns()
    for name in VIEWS:
        if gallery.wanted(name):
            gallery.example(name)
    if gallery.wanted("patterns-vase"):
        gallery.vases()
    if gallery.wanted("bunny-gravities"):
        gallery.gravities("bunny-gravities")
    for figure in FIGURES:
        if gallery.wanted(figure[0]):
            gallery.figure(*figure)


if __name__ == "__main__":
    main()
