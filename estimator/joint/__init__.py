"""mu_c and r solved together from each sample of true sliding, averaged with a fading memory."""
