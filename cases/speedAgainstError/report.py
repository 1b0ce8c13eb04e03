# SPDX-License-Identifier: GPL-3.0-or-later
"""Tables and pictures of a study."""

import math

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

SINGLE = "-single"  # ends the names of variants whose pairs are summed in single precision
STYLE = {"him": ("s", "tab:red"), "himCell": ("D", "tab:orange"), "p3m": ("o", "tab:blue"), "pairwiseSum": ("^", "tab:green"),
         "p3m, pairs in single": ("*", "tab:cyan"),
         "directTruncation": ("v", "tab:gray"), "hybridParticleCell": ("P", "tab:brown")}


def number(value, digits=3):
    return "-" if not value or math.isnan(value) else "%.*g" % (digits, value)


def table(header, rows):
    lines = ["| %s |" % " | ".join(header), "|" + "---|" * len(header)]
    return "\n".join(lines + ["| %s |" % " | ".join(row) for row in rows]) + "\n"


def base_time(rows):
    return next((row["warm_total_s"] for row in rows if row["name"] == "him-diagonal" and not row["left_out"]), math.nan)


def scene_table(scene):
    base = base_time(scene.rows)
    header = ["method", "parameters", "pairs", "near", "deposit", "solve", "gather", "exchange", "total [ms]", "cold solve [ms]", "x him",
              "MiB", "RMS error", "largest"]
    rows = []
    for row in scene.rows:
        if row["left_out"]:
            rows.append([row["name"], "left out: " + row["left_out"]] + [""] * (len(header) - 2))
            continue
        phases = [number(1e3 * row["warm_%s_s" % phase]) for phase in ("near", "deposit", "solve", "gather", "exchange")]
        rows.append([row["name"], row["parameters"], number(row["pairs_per_particle"]), *phases, number(1e3 * row["warm_total_s"]),
                     number(1e3 * row["cold_solve_s"]), number(row["warm_total_s"] / base), number(row["peak_MiB"]),
                     number(row["rms_error"], 2), number(row["largest_error"], 2)])
    first = next(row for row in scene.rows if not row["left_out"])
    text = "%d particles; mesh: %s; reference: %s; medians of %d rounds.\n\n" % (
        first["particles"], first["mesh"], first["reference"], min(row["rounds"] for row in scene.rows if not row["left_out"]))
    return "### %s\n\n%s%s" % (scene.title, text, table(header, rows))


def series(row):
    return row["fieldMethod"] + (", pairs in single" if row["name"].endswith(SINGLE) else "")


def draw_scenes(scenes, path):
    """Error against microseconds per particle, one panel for every scene."""
    columns = 3
    figure, panels = plt.subplots(math.ceil(len(scenes) / columns), columns, figsize=(11, 3.3 * math.ceil(len(scenes) / columns)),
                                  constrained_layout=True, squeeze=False)
    for panel in panels.flat[len(scenes):]:
        panel.axis("off")
    for panel, scene in zip(panels.flat, scenes):
        rows = [row for row in scene.rows if not row["left_out"] and row["rms_error"] > 1e-9]
        for method in dict.fromkeys(map(series, rows)):
            marker, colour = STYLE.get(method, ("x", "black"))
            mine = sorted((row["rms_error"], 1e6 * row["warm_total_s"] / row["particles"], row["name"]) for row in rows
                          if series(row) == method)
            panel.plot([time for _, time, _ in mine], [error for error, _, _ in mine], marker=marker, color=colour, linestyle=":", label=method)
            for error, time, name in mine:
                if method.startswith("p3m"):
                    panel.annotate(name[4:].replace(SINGLE, ""), (time, error), textcoords="offset points", xytext=(5, 3), fontsize=7)
        panel.set(xscale="log", yscale="log", title=scene.title, xlabel="us per particle and field", ylabel="RMS error")
        panel.title.set_fontsize(9)
        panel.grid(True, which="major", alpha=0.4)
    panels.flat[0].legend(fontsize=7)
    figure.savefig(path, dpi=80)
    plt.close(figure)


def growth_points(scenes, kind):
    """Name of the method to (particles, seconds, MiB) of every size."""
    points = {}
    for scene in scenes:
        if scene.title == kind:
            for row in scene.rows:
                if not row["left_out"]:
                    points.setdefault(row["name"], []).append((row["particles"], row["warm_total_s"], row["peak_MiB"]))
    return points


def exponent(points, above=9000):
    """Of time against number, between the smallest size above `above` and the largest."""
    large = [point for point in points if point[0] > above]
    if len(large) < 2:
        return math.nan
    return math.log(large[-1][1] / large[0][1]) / math.log(large[-1][0] / large[0][0])


def growth_table(scenes):
    rows = []
    for kind in ("dilute", "dense"):
        for name, points in growth_points(scenes, kind).items():
            cells = ", ".join("%d: %s s (%d MiB)" % (count, number(seconds), memory) for count, seconds, memory in points)
            rows.append([kind, name, cells, number(exponent(points))])
    return table(["density", "method", "particles: warm field (peak memory)", "exponent above 1e4"], rows)


def draw_growth(scenes, path):
    figure, axes = plt.subplots(figsize=(6, 4), constrained_layout=True)
    for kind, line in (("dilute", "-"), ("dense", "--")):
        for name, points in growth_points(scenes, kind).items():
            axes.plot([p[0] for p in points], [1e6 * p[1] / p[0] for p in points], "o" + line, label="%s, %s" % (name, kind))
    axes.set(xscale="log", yscale="log", xlabel="particles", ylabel="us per particle and field")
    axes.grid(True, which="major", alpha=0.4)
    axes.legend(fontsize=7)
    figure.savefig(path, dpi=80)
    plt.close(figure)


def seconds_at(entries, error):
    """Time at exactly this error, between the fastest settings on both sides of it (straight in the logarithms), and the names of
    these; None where the settings do not reach from one side to the other."""
    front = []
    for name, found, seconds in sorted(entries, key=lambda entry: entry[2]):
        if not front or found < front[-1][1]:
            front.append((name, found, seconds))
    for (worse, above, fast), (better, below, slow) in zip(front, front[1:]):
        if below <= error <= above:
            share = math.log(above / error) / math.log(above / below)
            return math.exp(math.log(fast) + share * math.log(slow / fast)), "%s to %s" % (worse, better)
    return None


def lammps_section(pair):
    rows = []
    for who, entries, charges in (("himField", pair["ours"], 1), ("LAMMPS", pair["theirs"], 8)):
        rows += [[who, name, number(error, 2), number(1e3 * seconds), number(1e6 * seconds / (charges * pair["particles"]))]
                 for name, error, seconds in sorted(entries, key=lambda entry: -entry[1])]
    text = ("### %s\n\n%d charges, %d images and charges in LAMMPS; medians over %d turns on the same core. The tight LAMMPS run that "
            "judges LAMMPS differs by %s from p3m-4h, whose error against the exact field of the box stands below.\n\n" % (
                pair["scene"], pair["particles"], 8 * pair["particles"], pair["rounds"], number(pair["check"], 2)))
    summary = []
    for wanted in (3e-2, 1e-2, 3e-3, 1e-3):
        us, them = seconds_at(pair["ours"], wanted), seconds_at(pair["theirs"], wanted)
        factor = them[0] / us[0] if us and them else math.nan
        summary.append([number(wanted, 1)]
                       + ["%s ms (%s)" % (number(1e3 * found[0]), found[1]) if found else "not reached" for found in (us, them)]
                       + [number(factor), number(factor / 8)])
    at_equal = table(["RMS error", "himField", "LAMMPS", "times faster", "per charge"], summary)
    return text + table(["program", "settings", "RMS error", "ms per field", "us per charge"], rows) + (
        "\nAt equal error, interpolated between the settings on both sides of it:\n\n") + at_equal


def overview(scenes):
    """One row per scene: error and time of the main methods."""
    names = ("him-diagonal", "him-3h", "p3m-2h", "p3m-3h", "p3m-4h", "p3m-2h" + SINGLE, "p3m-3h" + SINGLE, "p3m-4h" + SINGLE)
    rows = []
    for scene in scenes:
        by_name = {row["name"]: row for row in scene.rows if not row["left_out"]}
        base = base_time(scene.rows)
        rows.append([scene.title] + ["%s at %s" % (number(by_name[name]["rms_error"], 2), number(by_name[name]["warm_total_s"] / base, 2))
                                     if name in by_name else "-" for name in names])
    return table(["scene", *names], rows)


def write(folder, size, date, machine, scenes, growth, pairs):
    folder.mkdir(parents=True, exist_ok=True)
    draw_scenes(scenes, folder / "speedAgainstError.png")
    draw_growth(growth, folder / "growth.png")
    parts = [
        "<!-- SPDX-License-Identifier: GPL-3.0-or-later -->\n<!-- written by ./Allrun -->\n# Speed against error\n",
        "%s, %s. Study: %s. Times are warm, wall clock, of one field.\n" % (date, machine, size),
        "## At a glance\n\nRMS error at time, the time over that of `him-diagonal` in the same scene. Pairs are summed in double precision, by p3m "
        "with `-single` in single, which the other methods do not offer.\n\n" + overview(scenes),
        "![error against time](speedAgainstError.png)\n",
        "## Scenes\n\n" + "\n".join(scene_table(scene) for scene in scenes),
        "## Cost against the number of particles\n\nFixed density, h = 2 d, +-q.\n\n" + growth_table(growth) + "\n![growth](growth.png)\n",
        "## LAMMPS on the same charges\n",
    ]
    parts += [lammps_section(pair) for pair in pairs] or ["LAMMPS (`lmp`) is not installed, so this part was left out.\n"]
    (folder / "report.md").write_text("\n".join(parts))
