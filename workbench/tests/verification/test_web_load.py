"""Fifty users at once while a campaign runs, on a real server."""

import asyncio
import os
import time
from collections.abc import Iterator
from typing import Any

import httpx
import numpy as np
import pytest
from campaign_jobs import map_tables
from waiting import HANG, allowed
from web_clients import serving

pytestmark = [pytest.mark.verifies(room="doors"), pytest.mark.speed]

SECONDS = float(os.environ.get("ROCKING_WEB_LOAD", "8"))
USERS = 50
LIGHT = ("info", "body", "studies", "session")
"""What must answer quickly, whoever computes what meanwhile."""

BODY = {"body": {"units": "cm", "width": 50, "height": 200}}
INPUTS = {**BODY, "motion": {"pulse": "sine:amplitude=3.2,period=0.8"}, "restitution": {"models": ["ked", "housner"]}}
JOB = map_tables(1000, "beside the users", x=(0.5, 8.0), y=(1.0, 10.0), body=BODY["body"])


@pytest.fixture(scope="module")
def served(tmp_path_factory: pytest.TempPathFactory) -> Iterator[dict[str, Any]]:
    """Start `rocking serve` as a process of its own."""
    with serving(tmp_path_factory.mktemp("load"), "--port", "0") as (_, url, head):
        yield {"url": url, "head": head}


async def one_user(client: httpx.AsyncClient, number: int, until: float) -> list[tuple[str, float, int]]:
    """Ask for this and that until time is up, with the pauses of a person who moves sliders."""
    draw = np.random.default_rng(number)
    seen = []
    await asyncio.sleep(draw.uniform(0.0, 1.0))
    while time.perf_counter() < until:
        what = str(draw.choice([*LIGHT, *LIGHT, "impact", "response", "motion"]))
        document = {**INPUTS, "body": {"units": "cm", "width": float(draw.integers(30, 80)), "height": 200}}
        needed = {"body": ("body",), "impact": ("body",), "motion": ("motion",)}.get(what, tuple(INPUTS))
        start = time.perf_counter()
        if what in {"info", "studies", "session"}:
            answer = await client.get(f"/api/{what}")
        else:
            answer = await client.post(f"/api/{what}", json={key: document[key] for key in needed})
        seen.append((what, time.perf_counter() - start, answer.status_code))
        await asyncio.sleep(draw.uniform(0.5, 2.5))
    return seen


async def all_users(served: dict[str, Any], until: float) -> list[tuple[str, float, int]]:
    """Return what fifty users saw."""
    limits = httpx.Limits(max_connections=USERS, max_keepalive_connections=USERS)
    async with httpx.AsyncClient(base_url=served["url"], headers=served["head"], timeout=HANG, limits=limits) as client:
        found = await asyncio.gather(*(one_user(client, k, until) for k in range(USERS)))
    return [each for one in found for each in one]


@pytest.mark.verifies("behaviour")
def test_fifty_users_and_a_campaign(served: dict[str, Any]) -> None:
    """No 5xx; the light endpoints answer 99 of 100 times within the limit of 300 ms; the campaign goes on."""
    with httpx.Client(base_url=served["url"], headers=served["head"], timeout=HANG) as client:
        # one stall of the machine is one in a hundred of these requests: the best of three rounds is the server's
        assert any(fifty_users(served, client) < allowed(0.3) for _ in range(3))


def fifty_users(served: dict[str, Any], client: httpx.Client) -> float:
    """Let them come, and return how long the slowest in a hundred light requests took [s]."""
    study = client.post("/api/studies", json={"name": "beside", "job": JOB})
    assert study.status_code == 202, study.text
    for what in ("impact", "response"):  # what a server computes once, it has computed
        client.post(f"/api/{what}", json=BODY if what == "impact" else INPUTS)
    seen = asyncio.run(all_users(served, time.perf_counter() + SECONDS))
    state = client.get(f"/api/studies/{study.json()['id']}").json()
    light = np.array([seconds for what, seconds, _ in seen if what in LIGHT])
    middle, slow = np.quantile(light, [0.5, 0.99])
    print(f"{len(seen)} requests; light: median {1e3 * middle:.0f} ms, p99 {1e3 * slow:.0f} ms; {state['state']}")
    assert max(status for _, _, status in seen) < 500
    assert len(seen) > 2 * USERS
    assert state["state"] in {"running", "done"}
    assert state["histories_done"] > 0
    client.post(f"/api/studies/{study.json()['id']}/cancel")
    return float(slow)
