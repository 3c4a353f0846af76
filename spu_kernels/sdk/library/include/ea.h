#error there is no address space __ea here, and so no <ea.h>: move bytes of main storage by DMA, with mfc_get() and mfc_put()
