"""Replayed edits as one self-contained HTML page."""

import edit_plots as plots
from edit_data import KINDS
from page_html import (MISSING, by, card, cards, command, device_facts, document, esc, facts, figure, figures, masthead,
                       mebibytes, plural, section, table, times)
from page_input import number, section as part

GOAL = 1.5  # of the worst frame, in frames that it is compared with
WORST = 10  # frames that are listed
NO_STRUCTURE = {"none": "nothing", "nothing drawn": "nothing, as nothing was visible"}
CHANGED = {"script": "a script", "interpolation": "an interpolation", "usual": "edits of every kind"}


def of_summary(edit, *path):
    value = edit.section("summary")
    for name in path:
        value = part(value, name) if name != path[-1] else value.get(name)
    return number(value)


def the(edit):
    return esc(f"the {edit.compared}")


def served_by(edit, edited):
    """As "the bitfield octree (40 frames) and nothing (2 frames)"."""
    return " and ".join(f"{'' if name in NO_STRUCTURE else 'the '}{NO_STRUCTURE.get(name, KINDS.get(name, name))} "
                        f"({plural(count, 'frame')})" for name, count in edit.served(edited))


def what_served(edit):
    words = "A transfer function is edited while the volume is drawn."
    if edit.edits:
        words += f" What skipped empty space in the frames of edits: {served_by(edit, True)}."
    if len(edit.edits) < len(edit.frames):
        words += f" In those without: {served_by(edit, False)}."
    settled = part(edit.section("builds"), "settled").get("structure")
    if settled is None:
        serve = "serve" if edit.compared.endswith("s") else "serves"
        return f"{words} The {edit.compared} {serve} under any transfer function, and nothing is rebuilt."
    return (f"{words} When the hand rests, the {KINDS.get(settled, settled)} is rebuilt for the transfer function of "
            f"then, a little per frame; it took over {plural(sum(frame.swapped for frame in edit.frames), 'time')}.")


def head(edit):
    summary, volume, device = edit.section("summary"), edit.section("volume"), edit.section("device")
    worst, naive = of_summary(edit, "worst_over_octree_frame"), of_summary(edit, "naive", "worst_over_octree_frame")
    found = [card("Worst frame", times(worst), f"of a frame by {the(edit)} at rest; rebuilding all at once: "
                  f"{times(naive)}",
                  "skips" if worst is not None and worst <= GOAL else "")]
    added, spread = of_summary(edit, "worst_added_over_octree_frame"), of_summary(edit, "worst_octree_frame_over_median")
    if added is not None:
        found.append(card("Added at worst", f"{figures(100 * (added - 1))} %", "of such a frame, by edit, rebuilding and "
                          f"uploads; those by themselves vary up to {times(spread)} their median",
                          "skips" if added <= GOAL else ""))
    equal, to_correct = number(summary.get("frames_equal")), number(summary.get("frames_to_correct"))
    if equal is not None:
        found.append(card("From an edit to its picture",
                          MISSING if to_correct is None else plural(int(to_correct), "frame"),
                          f"{equal:.0f} of {len(edit.frames)} pictures as drawn from scratch, bit for bit",
                          "skips" if equal == len(edit.frames) else ""))
    else:
        found.append(card("From an edit to its picture", MISSING, "not compared: --verify does"))
    over = number(summary.get("frames_over_budget"))
    found.append(card("Frames over the budget", figures(over),
                      f"of {len(edit.frames)}; {budget_of(edit)}; rebuilding all at once: "
                      f"{figures(of_summary(edit, 'naive', 'frames_over_budget'))}", "skips" if over == 0 else ""))
    line = ", ".join(filter(None, (esc(volume.get("name", "volume")), by(volume.get("dims", [])),
                                   plural(len(edit.edits), "edit"), esc(device.get("renderer", "unknown device")))))
    words = f"<p>{esc(what_served(edit))}</p>"
    return masthead("live editing", "Is any frame of an edit slow?", line, device, words + cards(found))


def short_ms(value):
    return MISSING if value is None else "< 0.01" if value < 0.01 else figures(value)


def work(edit):
    return figure(plots.fetches, edit, "Texels that the live policy's frames look at: what they cost whatever the "
                  "machine. Counted beside the timed frames.")


def budget_of(edit):
    """As "1.5 times the frame by the bitfield octree of the same view and transfer function" """
    if edit.budget is not None:
        return f"{figures(edit.budget)} ms, as asked for"
    over = of_summary(edit, "budget_over_octree")
    return (f"{figures(over)} times the frame by {the(edit)} of the same view and transfer function"
            if over is not None else "budget not known")


def budget_words(edit):
    return f" The dashed line is the budget: {budget_of(edit)}." if edit.budgets else ""


def compared(edit):
    """A line per way: what its frames take."""
    summary = edit.section("summary")
    rows = []
    for name, of_all, of_edits, worst, over in (
            ("live policy", part(summary, "frame_ms"), part(summary, "edit_frame_ms"),
             of_summary(edit, "worst_over_octree_frame"), of_summary(edit, "frames_over_budget")),
            ("naive: all rebuilt at every edit", part(part(summary, "naive"), "frame_ms"),
             part(part(summary, "naive"), "edit_frame_ms"), of_summary(edit, "naive", "worst_over_octree_frame"),
             of_summary(edit, "naive", "frames_over_budget")),
            (f"{the(edit)}, made beforehand: nothing edited", part(summary, "octree_frame_ms"), {},
             of_summary(edit, "worst_octree_frame_over_median"), None)):
        rows.append([name, *(figures(of_all.get(key)) for key in ("median", "p90", "max")),
                     figures(of_edits.get("median")), figures(of_edits.get("max")), times(worst), figures(over)])
    return table(["ms per frame", "median", "90 %", "worst", "with an edit: median", "with an edit: worst",
                  f"worst, × {the(edit)}", "over budget"], rows)


def worst_frames(edit):
    slowest = sorted(enumerate(edit.frames), key=lambda one: -one[1].over_compared)[:WORST]
    rows = [[f"{i} <i>{esc(frame.step)}{', edit' if frame.edited else ''}{', hand-over' if frame.swapped else ''}</i>",
             times(frame.over_compared), *(short_ms(frame.times[name]) for name in (
                 "octree_ms", "frame_ms", "edit_ms", "work_ms", "prepare_ms", "draw_ms")), esc(frame.structure)]
            for i, frame in slowest]
    return table(["ms of frame", f"× {the(edit)}", the(edit), "frame", "edit", "rebuilding", "uploads", "drawing",
                  "skips by"], rows, css="rows")


def builds(edit):
    made = edit.section("builds")
    rows = []
    for name, entry, ms, when in (("right under any transfer function", part(made, "always"), "ms",
                                   "once, when editing begins"),
                                  ("faster under one of them", part(made, "settled"), "last_ms",
                                   "in pieces, when edits pause")):
        if entry:
            rows.append([name, esc(entry.get("structure", "")), figures(entry.get("skip_block")),
                         figures(entry.get(ms)), mebibytes(entry.get("gpu_bytes")) or MISSING, when])
    if number(made.get("naive_ms")) is not None:
        rows.append(["naive", esc(part(made, "settled").get("structure", "proximity")), MISSING,
                     figures(made["naive_ms"]), MISSING, "in every frame with an edit"])
    return table(["structure", "kind", "block edge", "built in, ms", "texture", "when"], rows) if rows else ""


def run_facts(edit):
    conditions = edit.section("conditions")
    replays = number(conditions.get("replays"))
    single = of_summary(edit, "worst_of_single_replays")
    return facts([
        *device_facts(edit.raw),
        ("Picture", by(conditions.get("size", []))),
        ("Ratio", f"{conditions.get('planes')} × {conditions.get('layers_per_plane')}"),
        ("Classification", esc(conditions.get("classify", ""))),
        ("Edits", CHANGED.get(conditions.get("edits"), "")),
        ("Rebuilding", f"{figures(conditions.get('work_budget_ms'))} ms a frame, after "
                       f"{figures(conditions.get('quiet_frames'))} frames without an edit"),
        ("Turned by", f"{figures(conditions.get('turn_degrees'))}°" if conditions.get("turn_degrees") else None),
        ("Replays", f"{figures(replays)}: each frame's times are medians; worst of any single one {times(single)}"
         if replays and replays > 1 else None),
        ("Compared with", f"{the(edit)}, made beforehand: median of {figures(conditions.get('octree_frames'))} frames "
                          "beside each"),
    ]) + command(edit.raw)


def page(edit):
    sections = [
        section("Every frame", figure(
            plots.trace, edit, "Time from the edit, where there is one, to the end of drawing." + budget_words(edit)
            + " The band below tells what skipped empty space in each frame; marks below it are edits.")),
        section("Beside drawing", figure(
            plots.parts, edit, "What the live policy adds to each frame: the table and what it shows, pieces of "
            "rebuilding, plan and uploads.")),
        section("Work", work(edit)),
        section("Compared", compared(edit)),
        section(f"Slowest frames, beside {the(edit)}", worst_frames(edit)),
        section("What is built", builds(edit)),
        section("This run", run_facts(edit)),
    ]
    return document("Live editing", head(edit), sections)
