"""The nodes that come with NEP Studio, each with a manifest beside it.

Enters a node, ``run`` and manifest, with what only it needs: ``sensory`` nodes measure,
``perceptual`` ones turn measurements into words, ``cognitive`` ones decide, ``action`` ones move a
robot. They import ``nep_core`` and ``robots``, never the studio. Running nodes meet on topics only;
libraries such as the simulated arm are shared. What another project could use of a robot stands
in ``robots``.
"""
