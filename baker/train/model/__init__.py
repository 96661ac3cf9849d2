"""What is trained: a network on a region's control graph, closed on its modal base, as the runtime ticks it."""
