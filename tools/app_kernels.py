"""Kernels of the explorer's pages, only so many at a time; loaded by the server of app.py."""

from jupyter_server.services.kernels.kernelmanager import AsyncMappingKernelManager
from tornado.web import HTTPError
from traitlets import Integer


class FewKernels(AsyncMappingKernelManager):
    """Starts no more kernels than it may; those of closed pages end by themselves."""

    most = Integer(8, config=True, help="Largest number of kernels at a time.")
    starting = 0

    async def start_kernel(self, *arguments, **options):
        if len(self) + self.starting >= self.most:
            words = f"{self.most} pages are open: close one and wait a minute"
            raise HTTPError(503, words, reason=words)
        self.starting += 1
        try:
            return await super().start_kernel(*arguments, **options)
        finally:
            self.starting -= 1
