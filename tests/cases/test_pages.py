"""What is written from the types of tables: the JSON Schema."""

from railbridge.cases import pages
from railbridge.cases.tabletypes import key, table, text

SCHEMA = pages.schema()


def test_the_schema_says_what_every_table_and_every_key_means():
    tables = {n: t for n, t in SCHEMA["$defs"].items() if "properties" in t} | {"Case": SCHEMA}
    for name, content in tables.items():
        assert content["description"].endswith("."), name
        for own, value in content["properties"].items():
            # A table may speak for the only key that holds it.
            said = value if "description" in value else tables[value["$ref"].rpartition("/")[2]]
            assert len(said["description"]) > 1, (name, own)
    assert tables["BoxDeck"]["description"].startswith("A box girder from its dimensions")


def test_a_key_may_bear_a_name_that_a_schema_knows_otherwise(monkeypatch):
    names = ("title", "default", "discriminator", "properties")
    keys = {name: key(text(), f"The {name}.") for name in names}
    inner = table("Inner", "A table.", **keys)
    outer = table("Outer", "A table of tables.", inner=key(inner, "Inside."), **keys)
    monkeypatch.setattr(pages.tables, "CASE", outer)
    found = pages.schema()
    assert set(found["properties"]) == {*names, "inner"}
    assert set(found["$defs"]["Inner"]["properties"]) == set(names)
    for content in (found, found["$defs"]["Inner"]):
        assert "title" not in content
        assert all("title" not in value for value in content["properties"].values())
