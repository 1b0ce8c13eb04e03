#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs the single contacts, compares them with the stated law and writes runs/report.md and singleContact.png. Usage: study.py
[-short]"""

import sys

from contacts import BANDS, CONTACTS, dem

LIMIT = 0.01                    # simulated against the stated law
DAMPED_AREA = 0.9596            # largest area with restitution 0.9 over that with 1
SHARES = (0.01, 0.05, 0.1, 0.2, 0.3, 0.4)
PICO = 1e12


class Study:
    def __init__(self, short):
        self.bands = ["average"] if short else list(BANDS)
        self.contacts = CONTACTS[::5] if short else CONTACTS      # PTFE and a PA66 pair
        self.lines, self.failed, self.rows = [], [], {}

    def simulated(self, contact, band, restitution=1.0, share=0.2, plane=False):
        """Charges [C] moved in impacts that begin at different parts of a time step."""
        text, steps = contact.script(band, restitution, share, plane)
        name = "-".join([contact.name.replace(" ", "_"), band, f"e{restitution:g}", f"{100*share:g}percent", "2d" if plane else "3d"])
        return contact.transfers(dem.run("runs/" + name, text, ["q"], steps, steps))

    def claim(self, text, holds):
        if not holds:
            self.failed.append(text)
        return "" if holds else " **FAILED**"

    def worst(self, found, law):
        return max((value/law - 1 for value in found), key=abs)

    def table(self):
        self.lines += ["Charge moved in one contact [pC], time step 20 % of the Rayleigh step, mean of 8 impacts:", "",
                       "| contact | parameters | experiment | frozen | updated | updated, elastic wall | simulated 3D | worst of 8 off by | "
                       "2D - 3D | simulated, e = 0.9 | off by |", "|---|---|" + "---|"*9]
        for contact in self.contacts:
            for band in self.bands:
                frozen, updated = contact.laws(contact.impact(rigid=True).area, band)
                _, elastic = contact.laws(contact.impact().area, band)
                _, damped = contact.laws(DAMPED_AREA*contact.impact().area, band)
                solid, flat = (self.simulated(contact, band, plane=plane) for plane in (False, True))
                soft = self.simulated(contact, band, restitution=0.9)
                mean = sum(solid)/len(solid)
                self.rows[contact.name, band] = (frozen, updated, mean, sum(soft)/len(soft))
                off, off_damped = self.worst(solid, elastic), self.worst(soft, damped)
                same = max(abs(a - b) for a, b in zip(solid, flat))
                experiment = f"{PICO*contact.experiment:.4g}" if band == "average" else ""
                what = f"{contact.name}, {band}"
                self.lines.append(
                    f"| {contact.name} | {band} | {experiment} | {PICO*frozen:.4g} | {PICO*updated:.4g} | {PICO*elastic:.4g} | {PICO*mean:.4g} | "
                    f"{100*off:+.2f} %{self.claim(what + ': elastic', abs(off) <= LIMIT)} | "
                    f"{PICO*same:.1g}{self.claim(what + ': 2D', same <= 1e-12*abs(mean))} | {PICO*sum(soft)/len(soft):.4g} | "
                    f"{100*off_damped:+.2f} %{self.claim(what + ': damped', abs(off_damped) <= LIMIT)} |")

    def steps(self):
        self.lines += ["", "Time step over Rayleigh step, PTFE on aluminium and the 3.18 mm PA66 pair, largest difference of 8 impacts from the "
                       "stated law:", "", "| share | PTFE on Al | PA66 3.18 mm pair |", "|---|---|---|"]
        for share in SHARES:
            cells = []
            for contact in (CONTACTS[0], CONTACTS[5]):
                _, law = contact.laws(contact.impact().area, "average")
                off = self.worst(self.simulated(contact, "average", share=share), law)
                cells.append(f"{100*off:+.2f} %{self.claim(f'{contact.name} at {share}', abs(off) <= LIMIT or share > 0.2)}")
            self.lines.append(f"| {100*share:g} % | {cells[0]} | {cells[1]} |")

    def write(self):
        text = "\n".join(self.lines) + "\n"
        with open("runs/report.md", "w") as file:
            file.write(text)
        print(text)
        for what in self.failed:
            print("FAILED:", what)


def draw(study):
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    blue, orange, grey, ink = "#1f5fa8", "#d9772b", "#8a8f98", "#22262e"
    figure, all_axes = plt.subplots(1, len(study.contacts), figsize=(2.1*len(study.contacts), 3.6))
    for axes, contact in zip(all_axes, study.contacts):
        rows = [study.rows[contact.name, band] for band in BANDS]
        scale = abs(contact.experiment)
        for place, (column, colour) in enumerate(((0, grey), (1, ink), (2, blue), (3, orange)), start=1):
            low, mean, high = (abs(row[column])/scale for row in rows)
            axes.errorbar(place, mean, [[mean - low], [high - mean]], fmt="o", color=colour, capsize=4)
        axes.axhline(1, color=grey, lw=1, ls=":")
        axes.set_xticks(range(1, 5), ["frozen", "updated", "e = 1", "e = 0.9"], rotation=60)
        axes.set_xlim(0.4, 4.6)
        axes.set_title(contact.name, fontsize=9)
        axes.set_ylim(0, 1.7)
    all_axes[0].set_ylabel("charge moved / experiment")
    figure.tight_layout()
    figure.savefig("singleContact.png", dpi=100)
    print("wrote singleContact.png")


def main():
    short = "-short" in sys.argv[1:]
    study = Study(short)
    study.table()
    if not short:
        study.steps()
    study.write()
    if not short:
        draw(study)
    return 1 if study.failed else 0


if __name__ == "__main__":
    sys.exit(main())
