"""A kernel that is asked to run cells by name, as JupyterLab asks."""

from contextlib import contextmanager

from jupyter_client.manager import start_new_kernel

ANSWERS_WITHIN = 120.0  # s


class Cells:
    """The cells of a notebook whose kernel runs.

    Parameters
    ----------
    client : KernelClient
    """

    def __init__(self, client):
        self.client = client

    def run(self, code, cell=None):
        """Run code as the cell of this name, or as one without a name; return what it printed."""
        content = {
            "code": code, "silent": False, "store_history": True, "user_expressions": {},
            "allow_stdin": False, "stop_on_error": True,
        }  # fmt: skip
        metadata = {"cellId": cell} if cell else {}
        request = self.client.session.msg("execute_request", content, metadata=metadata)
        self.client.shell_channel.send(request)
        printed, raised = [], None
        while True:
            message = self.client.get_iopub_msg(timeout=ANSWERS_WITHIN)
            if message["parent_header"].get("msg_id") != request["header"]["msg_id"]:
                continue
            kind, said = message["msg_type"], message["content"]
            if kind == "error":
                raised = f"{said['ename']}: {said['evalue']}"
            if kind == "stream":
                assert said["name"] == "stdout", said["text"]
                printed.append(said["text"])
            if kind == "status" and said["execution_state"] == "idle":
                assert raised is None, raised
                return "".join(printed).strip()


@contextmanager
def running_cells():
    manager, client = start_new_kernel()
    try:
        yield Cells(client)
    finally:
        client.stop_channels()
        manager.shutdown_kernel(now=True)
