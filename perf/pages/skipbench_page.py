"""The ways of skipping, compared, as one self-contained HTML page."""

import skipbench_plots as plots
import skipbench_tables as tables
from page_html import by, card, cards, command, device_facts, document, esc, facts, figure, figures, masthead, section
from page_html import coverage_words, interval, mebibytes, times
from page_input import number

TITLE = "Which way past empty space?"
PAIRED = ("In every round each candidate draws the same view once, in an order shuffled anew; a ratio is the median over "
          "the rounds of none’s time over the candidate’s of the same round, so that a drifting machine hits both. Whiskers: "
          "the interval of that median.")


def volume_sections(bench, entry):
    volume = entry.get("name", "volume")
    name = esc(volume)
    what = " · ".join(filter(None, (by(entry.get("dims")), esc(entry.get("type", "")),
                                    esc(entry.get("transfer_function", "")))))
    casting = figure(plots.speedups(bench, volume), bench,
                     "Each structure with the parameters that suit it best (partitioned maps with usual ones), on equal "
                     "terms otherwise: one plane, the same camera, layers and target. Bars start at the line, what none takes: to its left is slower. "
                     + PAIRED)
    others = figure(plots.families(bench, volume), bench,
                    "Filled: planes as rectangles around what the structure finds visible; hollow: planes of the "
                    "whole sphere. Rectangles of none are from blocks. Hybrid: each at its best ratio, against none of "
                    "the whole sphere at its own best. " + PAIRED)
    merges = figure(plots.merging(bench, volume), bench,
                    "Merging partitioned maps against rebuilding the Chebyshev map (black; the median of the transfer "
                    "functions), by block edge. What is not drawn was over the memory budget, or left out of a quick "
                    "run.")
    return [
        section(f"{name}: ray casting", casting and f"<p class=lede>{what}</p>" + casting + tables.ray_casting(bench, volume)),
        section(f"{name}: work at equal parameters", tables.work(bench, volume)),
        section(f"{name}: hybrid and slicing", others and others + tables.families(bench, volume)),
        section(f"{name}: building and memory", tables.generation(bench, volume)),
        section(f"{name}: which parameters", tables.searched(bench, volume)),
        section(f"{name}: a new transfer function", merges and merges + tables.merging(bench, volume)),
    ]


def sizes_section(bench):
    drawn = figure(plots.sizes, bench, "Every structure with the same parameters: blocks or leaves of 4 voxels, "
                   "32 bits, 64 partitions. Memory: on the GPU, and of partitioned maps on the host. Frames are those of "
                   "ray casting, marching only.")
    return section(f"Cost against size: {esc(bench.sized)}",
                   drawn and drawn + tables.sizes(bench))


def head(bench):
    judged = [entry for entry in bench.figures if entry.get("reached") is not None]
    reached = sum(1 for entry in judged if entry["reached"])
    found = []
    if judged:
        found.append(card("Figures reached", f"{reached} of {len(judged)}", "goals set beforehand; listed below",
                          "skips" if reached == len(judged) else ""))
    for entry in bench.volumes[:2]:
        rows = bench.of("frames", volume=entry.get("name"), family="ray casting", mode="early exit")
        best = max(rows, key=lambda row: row.speedup, default=None)
        if best:
            found.append(card(f"{esc(entry.get('name', ''))}, ray casting, early exit", times(best.speedup),
                              f"{interval(*best.interval)}; {esc(best.name)}; {figures(best.ms)} ms", "skips"))
    device = bench.section("device")
    line = ", ".join([*(esc(entry.get("name", "")) for entry in bench.volumes),
                      esc(device.get("renderer", "unknown device"))])
    return masthead("skipping", TITLE, line, device, cards(found))


def run_facts(bench):
    conditions = bench.section("conditions")
    camera, frames = conditions.get("camera"), conditions.get("frames_per_row_at_most")
    spacing = number(conditions.get("layer_spacing"))
    return facts([
        *device_facts(bench.raw),
        ("Picture", by(conditions.get("size"))),
        ("Camera", f"{', '.join(figures(v) for v in camera)}; {figures(conditions.get('fov_degrees'))}° high"
         if isinstance(camera, list) else None),
        ("Layers", f"every {figures(spacing)} of the smallest voxel edge, {esc(conditions.get('lattice', ''))}" if spacing else None),
        ("Early exit at", figures(conditions.get("termination"))),
        ("Target, space", " · ".join(esc(conditions[name]) for name in ("target", "space") if conditions.get(name))),
        ("Partition budget", mebibytes(conditions.get("partition_budget_bytes"))),
        ("Frames per row", f"at most {esc(frames)}{' (quick run)' if conditions.get('quick') else ''}" if frames
         else None),
        ("Order", "shuffled anew in every round"),
        ("Intervals", coverage_words(next((row.at("speedup_coverage") for row in bench.of("frames")), None))),
        ("Rows", len(bench.rows)),
    ]) + command(bench.raw)


def page(bench):
    judged = any(entry.get("goal") is not None for entry in bench.figures)
    sections = [section("Figures to reach" if judged else "Figures", tables.figures_to_reach(bench))]
    for entry in bench.volumes:
        sections += volume_sections(bench, entry)
    sections += [sizes_section(bench) if bench.sized else "", section("This run", run_facts(bench))]
    return document(TITLE, head(bench), sections)
