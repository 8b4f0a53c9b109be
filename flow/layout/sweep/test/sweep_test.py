"""The front of a set of points, plots of points that did not close, names that are not there."""

from talbot.base.charts import save
from talbot.base.command import main
from talbot.flow.layout.sweep import command
from talbot.flow.layout.sweep.plots import effort_plot, front, pareto_plot
from talbot.flow.layout.sweep.points import candidates


def test_the_front_is_what_nothing_beats():
    points = [{"area": a, "speed": s} for a, s in ((1, 1), (2, 5), (3, 4), (4, 9), (4, 8), (2, 5))]
    assert [(p["area"], p["speed"]) for p in front(points, "area", "speed")] == [(1, 1), (2, 5), (2, 5), (4, 9)]


def test_plots(tmp_path):
    point = {"variant": "radix4", "bits": 8, "closed": True, "area_um2": 1e4, "f_max_mhz": 80.0, "pj_result": 20.0}
    rest = [point | {"variant": "cordic", "pj_result": None}, {"variant": "radix2", "bits": 4, "closed": False}]
    save(pareto_plot([point, *rest]), tmp_path / "pareto.png")
    tried = {"effort": 3, "spread": 0.5, "utilization": 0.8, "seconds": 9.0, "closed": False}
    closed = tried | {"closed": True, "area_um2": 1e4, "wire_um": 1e4, "wns_ns": 3.0}
    save(effort_plot([closed, tried | {"utilization": 0.9}]), tmp_path / "e.png")
    assert all((tmp_path / name).stat().st_size > 10_000 for name in ("pareto.png", "e.png"))


def test_every_variant_is_a_candidate():
    made = {design.name: design for design in candidates()}
    assert len(made) == 10 and made["radix2_12"].options == ("--n-frac=12",) and made["cordic_8"].top == "Cordic"


def test_bad_arguments(tmp_path, capsys):
    (tmp_path / "a.lib").write_text("library (a) {}")
    ask = ["pareto", "--out", str(tmp_path / "out"), "--liberty"]
    assert main(command, [*ask, str(tmp_path / "a.lib"), "--only", "radix8_8"]) == 2
    assert main(command, [*ask, str(tmp_path / "b.lib")]) == 2
    assert capsys.readouterr().err.count("\n") == 2 and not (tmp_path / "out").exists()
