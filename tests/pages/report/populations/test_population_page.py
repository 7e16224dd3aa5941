import base64
import json
import re
import zlib
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import cytodisk as cd
from cytodisk.errors import ParameterError
from cytodisk.pages.population.drawn_population import DrawnPopulation
from cytodisk.pages.report.page import write_report
from cytodisk.pages.report.populations.population_html import population_page
from cytodisk.pages.report.populations.population_words import methods
from cytodisk.store.populations.population_study import PopulationStudy

pytestmark = pytest.mark.slow


def data_of(page: Path | str) -> Any:
    text = page.read_text(encoding="utf-8") if isinstance(page, Path) else page
    found = re.search(r'<script type="application/json" id="data">(.*?)</script>', text, re.DOTALL)
    assert found is not None
    return json.loads(found[1])


def array(packed: dict[str, Any]) -> np.ndarray[Any, Any]:
    numbers = np.frombuffer(zlib.decompress(base64.b64decode(packed["data"])), dtype="<f4")
    return numbers.reshape(packed["shape"])


def test_finding_and_best_p_come_first(compared: PopulationStudy, population_written: Path) -> None:
    body = population_written.read_text(encoding="utf-8").split("<body")[1].split("<script")[0]
    assert "drug against control: " in body
    assert "4 + 4 experiments, smallest p possible 0.029" in body
    assert body.index("smallest p possible") < body.index('id="flags"') < body.index('id="maps"')
    assert all(words in body.replace("&#39;", "'") for words in compared.sentences)


def test_arrays_are_those_of_the_study(compared: PopulationStudy, population_written: Path) -> None:
    data = data_of(population_written)
    assert data["conditions"] == ["control", "drug"]
    atlas = array(data["atlas"]["mean"]).reshape(2, 2, 3, 8)
    np.testing.assert_allclose(atlas, compared.atlas_arrays["mean"], rtol=1e-6)
    found = compared.window_arrays("drug")
    for name in ("difference", "p_fwer", "effect_size"):
        shown = array(data["comparisons"][0]["windows"][name]).reshape(2, 3, 8)
        np.testing.assert_allclose(shown, found[name], rtol=1e-5)


def test_cells_are_linked_to_the_pages_of_their_studies(population_written: Path) -> None:
    data = data_of(population_written)
    assert data["cells"]["link"][0] == "../maps/report.html#cell-0"
    assert data["tables"]["cells"]["links"] == data["cells"]["link"]
    page, cell = data["cells"]["link"][-1].split("#cell-")
    assert (population_written.parent / page).is_file()
    assert int(cell) == len(data["cells"]["link"]) - 1


def test_page_needs_no_network(population_written: Path) -> None:
    text = population_written.read_text(encoding="utf-8")
    assert re.findall(r"""src=["']?(?!data:)([^"'> ]+)""", text.split("<script>")[0]) == []
    assert text.count("</script>") == text.count("<script")
    assert len(text) < 1_000_000


def test_methods_name_what_was_done(compared: PopulationStudy) -> None:
    words = methods(DrawnPopulation(compared))
    assert "divided by the mean of their cell" in words
    assert "experiments were compared" in words
    assert "n = 4 and 4 experiments" in words
    assert "max-T" in words


def test_nothing_to_conclude_is_said_first(compared: PopulationStudy, tmp_path: Path) -> None:
    groups = tmp_path / "groups.csv"
    known = compared.cells[["source", "label", "condition"]]
    known.rename(columns={"source": "file", "label": "cell"}).to_csv(groups, index=False)
    maps = cd.open_study(compared.path.parent / "maps")
    plain = maps.path.parent / "plain"
    made = compared.path.parent / "images"
    cd.run_map(made / "masks", plain, signal=made / "images", layers=2, sectors=4)
    study = cd.run_population(plain, tmp_path / "out", groups=groups)
    text = population_page(study)
    body = text.split("<body")[1].split("<script")[0]
    assert study.sentences[0] in body.split('class="finding"')[1].split("</p>")[0].replace("&#39;", "'")
    assert "experiments unknown" in body
    assert "Conditions were described, not tested." in body
    assert "Nothing was tested: no window is marked." in body
    data = data_of(text)
    assert not data["tested"]
    assert {scalar["what"] for scalar in data["scalars"]} == {""}


def test_names_stay_names(compared: PopulationStudy) -> None:
    bad = "drug <b>&</script>"
    provenance = dict(compared.provenance)
    provenance["sentences"] = [f"{bad} differs"]
    text = population_page(PopulationStudy(compared.path, provenance))
    assert bad not in text
    assert "drug &lt;b&gt;&amp;&lt;/script&gt; differs" in text


def test_cell_is_not_for_a_population(compared: PopulationStudy) -> None:
    with pytest.raises(ParameterError, match="cell is for the study of one input"):
        write_report(compared, cell=1)
