"""Which pages may drive the viewer: its own only."""

import pytest

from policies.play.viewer.guard import guard, is_own_page

LOCAL = "127.0.0.1"


@pytest.mark.parametrize(
    ("hosts", "origins", "host", "own"),
    [
        (["127.0.0.1:8080"], ["http://127.0.0.1:8080"], LOCAL, True),
        (["localhost:8080"], ["http://localhost:8080"], LOCAL, True),
        (["LOCALHOST:9000"], ["http://localhost:9000"], LOCAL, True),  # a forwarded port
        (["[::1]:8080"], ["http://[::1]:8080"], "::1", True),
        (["192.168.1.7:8080"], ["http://192.168.1.7:8080"], "0.0.0.0", True),
        (["lab-pc:8080"], ["http://lab-pc:8080"], "lab-pc", True),
        (["127.0.0.1:8080"], ["http://evil.example"], LOCAL, False),
        (["127.0.0.1:8080"], ["http://127.0.0.1:8081"], LOCAL, False),  # another server of this machine
        (["127.0.0.1:8080"], ["http://localhost:8080"], LOCAL, False),
        (["evil.example:8080"], ["http://evil.example:8080"], LOCAL, False),  # DNS rebinding
        (["127.0.0.1.evil.example"], ["http://127.0.0.1.evil.example"], LOCAL, False),
        (["evil.example:8080"], ["http://evil.example:8080"], "0.0.0.0", False),
        (["127.0.0.1:8080"], ["null"], LOCAL, False),
        (["127.0.0.1:8080"], ["file://127.0.0.1:8080"], LOCAL, False),
        (["127.0.0.1:8080"], ["http://[127.0.0.1:8080"], LOCAL, False),
        (["127.0.0.1:8080"], [], LOCAL, False),
        ([], ["http://127.0.0.1:8080"], LOCAL, False),
        (["127.0.0.1:8080", "evil.example"], ["http://127.0.0.1:8080"], LOCAL, False),
        (["127.0.0.1:8080"], ["http://127.0.0.1:8080", "http://evil.example"], LOCAL, False),
    ],
)
def test_only_a_page_of_this_server_is_its_own(hosts, origins, host, own):
    assert is_own_page(hosts, origins, host) is own


def test_a_viser_that_hides_its_connections_is_refused():
    class Server:
        stopped = False

        def stop(self):
            self.stopped = True

    server = Server()
    with pytest.raises(RuntimeError, match=r"viser==1\.1\.1"):
        guard(server, LOCAL)
    assert server.stopped
