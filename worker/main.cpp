// The process in which a solver runs when it is kept apart. Its line to the host is descriptor 3.
#include "plugins/worker_serve.h"

#include <sys/prctl.h>
#include <sys/socket.h>

#include <csignal>
#include <cstdio>

int main()
{
   constexpr int kLine = 3;
   int type = 0;
   socklen_t size = sizeof type;
   if (::getsockopt(kLine, SOL_SOCKET, SO_TYPE, &type, &size) != 0 || type != SOCK_SEQPACKET) {
      std::fputs("diatom-worker is started by diatom and diatom-studio; it does nothing by itself\n", stderr);
      return 2;
   }
   std::signal(SIGINT, SIG_IGN); // Ctrl+C is for the host, which cancels what runs here
   ::prctl(PR_SET_PDEATHSIG, SIGKILL);
   return diatom::serveSolver(diatom::Line(diatom::Descriptor(kLine)));
}
