"""The front of a set of points, plots of points that did not close, names that are not there."""

from talbot.base.charts import save
from talbot.base.command import main
from talbot.flow.layout.sweep import command
from talbot.flow.layout.sweep.plots import front, pareto_plot
from talbot.flow.layout.sweep.points import candidates


def test_the_front_is_what_nothing_beats():
    points = [{"area": a, "speed": s} for a, s in ((1, 1), (2, 5), (3, 4), (4, 9), (4, 8), (2, 5))]
    assert [(p["area"], p["speed"]) for p in front(points, "area", "speed")] == [(1, 1), (2, 5), (2, 5), (4, 9)]


def test_plots(tmp_path):
    point = {"variant": "radix4", "bits": 8, "closed": True, "area_um2": 1e4, "f_max_mhz": 80.0, "pj_result": 20.0}
    rest = [point | {"variant": "cordic", "pj_result": None}, {"variant": "radix2", "bits": 4, "closed": False}]
    save(pareto_plot([point, *rest]), tmp_path / "pareto.png")
    assert (tmp_path / "pareto.png").stat().st_size > 10_000


def test_every_variant_is_a_candidate():
    made = {design.name: design for design in candidates()}
    assert len(made) == 10 and made["radix2_12"].options == ("--n-frac=12",) and made["cordic_8"].top == "Cordic"


def test_bad_arguments(tmp_path, capsys):
    (tmp_path / "a.lib").write_text("library (a) {}")
    ask = ["--out", str(tmp_path / "out"), "--liberty"]
    assert main(command, [*ask, str(tmp_path / "a.lib"), "--only", "radix8_8"]) == 2
    assert main(command, [*ask, str(tmp_path / "b.lib")]) == 2
    assert capsys.readouterr().err.count("\n") == 2 and not (tmp_path / "out").exists()
